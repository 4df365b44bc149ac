#include "import/step_triangles.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <unordered_map>

#include "import/check_text.hpp"
#include "import/step_entities.hpp"

namespace tegotae {
namespace {

// Shapes may name a face of which there is one in the file several times; more triangles a byte are made to do harm.
constexpr std::size_t kMaxTrianglesPerByte = 16;

constexpr std::string_view kRepresentation = "TESSELLATED_SHAPE_REPRESENTATION";
constexpr std::string_view kRepositioned = "REPOSITIONED_TESSELLATED_ITEM";

bool begins(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

bool has(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

bool is_representation(std::string_view kind) {
  constexpr std::string_view end = "SHAPE_REPRESENTATION";
  return begins(kind, kRepresentation) || (kind.size() >= end.size() && kind.substr(kind.size() - end.size()) == end);
}

bool is_tessellated(std::string_view kind) {
  return !is_representation(kind) && (has(kind, "TESSELLATED_") || has(kind, "TRIANGULATED_"));
}

/// The entities of a file that have to do with triangles.
class StepTriangleReader {
 public:
  StepTriangleReader(const std::string& path, std::string_view bytes)
      : path_(path), bytes_(bytes), statements_(step_statements(path, bytes)) {}

  PlainStep read() {
    for (const StepStatement& s : statements_) index(s);
    for (const auto& [id, entity] : entities_)
      if (is_representation(entity.kind)) find_items(id, entity);
    PlainStep out;
    out.text.reserve(bytes_.size());
    for (const StepStatement& s : statements_) write(s, out);
    return out;
  }

 private:
  struct Entity {
    std::string_view kind;
    std::string_view values;  ///< from its `(` on
  };

  StepCursor cursor(std::uint64_t id, std::string_view text) const { return {path_, id, text}; }

  void index(const StepStatement& s) {
    last_ = std::max(last_, s.id);
    if (s.id == 0) return;
    StepCursor at = cursor(s.id, s.value);
    Entity entity;
    entity.kind = at.word();
    entity.values = at.rest();
    if (entity.kind.empty() && has(s.value, "TESSELLATED_")) entity = complex(s);
    if (is_tessellated(entity.kind) || is_representation(entity.kind) || entity.kind == "COORDINATES_LIST")
      entities_[s.id] = entity;
  }

  /// `(A(...)B(...))`: a representation with the values of REPRESENTATION, or a tessellated item that is not read.
  Entity complex(const StepStatement& s) const {
    Entity out;
    StepCursor at = cursor(s.id, s.value);
    at.expect('(');
    while (!at.take(')')) {
      const std::string_view kind = at.word();
      if (kind.empty()) at.damaged("has no kind");
      if (kind == "REPRESENTATION") out.values = at.rest();
      if (is_representation(kind) || (is_tessellated(kind) && out.kind != kRepositioned)) out.kind = kind;
      at.list([&] { at.skip(); });
    }
    if (is_tessellated(out.kind) && out.kind != kRepositioned) out.kind = "TESSELLATED_ITEM of several kinds";
    return out;
  }

  /// The tessellated items of a representation.
  void find_items(std::uint64_t id, const Entity& representation) {
    StepCursor at = cursor(id, representation.values);
    at.expect('(');
    at.skip();
    at.expect(',');
    if (!begins(at.rest(), "(")) return;  // CONTEXT_DEPENDENT_SHAPE_REPRESENTATION
    at.list([&] {
      if (!begins(at.rest(), "#")) return at.skip();  // not as the standard says: OpenCASCADE's matter
      const std::uint64_t item = at.reference();
      const auto found = entities_.find(item);
      if (found != entities_.end() && is_tessellated(found->second.kind)) items_.insert(item);
    });
  }

  void write(const StepStatement& s, PlainStep& out) {
    const auto found = entities_.find(s.id);
    if (found != entities_.end() && begins(found->second.kind, kRepresentation)) {
      write_representation(s.id, found->second, out.text);
    } else if (items_.count(s.id) > 0) {
      out.shapes.push_back(shape_of(s.id, out.unread));
      write_points(s.id, out.text);
    } else {
      out.text += s.text;
    }
  }

  /// As an ordinary one: of its values the name, the items and the context.
  void write_representation(std::uint64_t id, const Entity& representation, std::string& text) const {
    StepCursor at = cursor(id, representation.values);
    at.expect('(');
    const std::string_view from = at.rest();
    at.skip();
    at.expect(',');
    at.skip();
    at.expect(',');
    at.skip();
    text += "\n#" + std::to_string(id) + "=SHAPE_REPRESENTATION(";
    text += from.substr(0, from.size() - at.rest().size());
    text += ");";
  }

  void write_points(std::uint64_t id, std::string& text) {
    std::string points;
    for (const char* at : {"0.,0.,0.", "1.,0.,0.", "0.,1.,0.", "0.,0.,1."}) {
      const std::string point = '#' + std::to_string(++last_);
      text += '\n' + point + "=CARTESIAN_POINT('',(" + at + "));";
      points += (points.empty() ? "" : ",") + point;
    }
    text += "\n#" + std::to_string(id) + "=GEOMETRIC_SET('',(" + points + "));";
  }

  StepTriangles shape_of(std::uint64_t id, std::vector<std::string>& unread) {
    StepTriangles out;
    out.id = id;
    corner_of_.clear();
    const Entity& entity = entities_.at(id);
    StepCursor at = cursor(id, entity.values);
    if (entity.kind == "TESSELLATED_SOLID" || entity.kind == "TESSELLATED_SHELL" ||
        entity.kind == "TESSELLATED_GEOMETRIC_SET") {
      at.expect('(');
      at.skip();
      at.expect(',');
      at.list([&] { add_face(at.reference(), out.mesh, unread); });
      if (at.take(',')) out.exact = at.optional();
    } else {
      add_face(id, out.mesh, unread);
    }
    return out;
  }

  /// Adds the triangles of a face or a set of triangles.
  void add_face(std::uint64_t id, TriangleMesh& to, std::vector<std::string>& unread) {
    const auto found = entities_.find(id);
    if (found == entities_.end()) refuse(path_, "damaged: it has no tessellated entity #" + std::to_string(id));
    const Entity& entity = found->second;
    const bool strips = begins(entity.kind, "COMPLEX_");
    const std::string_view plain = entity.kind.substr(strips ? 8 : 0);
    if (plain == "TRIANGULATED_FACE" || plain == "TRIANGULATED_SURFACE_SET") {
      add_triangles(id, entity, plain == "TRIANGULATED_FACE", strips, to);
      return;
    }
    for (const char* lines : {"EDGE", "VERTEX", "WIRE", "CURVE_SET", "POINT_SET"})
      if (has(entity.kind, lines)) return;  // nothing that could be touched
    unread.push_back("#" + std::to_string(id) + " is a " + std::string(entity.kind));
  }

  void add_triangles(std::uint64_t id, const Entity& entity, bool is_face, bool strips, TriangleMesh& to) {
    StepCursor at = cursor(id, entity.values);
    at.expect('(');
    at.skip();  // name
    at.expect(',');
    const std::uint64_t list = at.reference();
    const std::vector<Vec3>& points = points_of(list);
    at.expect(',');
    at.skip();  // how many points it has
    at.expect(',');
    at.skip();  // normals
    at.expect(',');
    if (is_face) {
      at.skip();  // the exact face
      at.expect(',');
    }
    std::vector<std::uint64_t> own;  // of the file's points those of this face; none: all
    at.list([&] { own.push_back(at.index()); });
    at.expect(',');
    const auto corner = [&] {
      std::uint64_t i = at.index();
      if (!own.empty()) i = i <= own.size() ? own[i - 1] : 0;
      if (i == 0 || i > points.size()) at.damaged("has an index out of range");
      return corner_of(list, i - 1, points, to);
    };
    if (!strips) {
      at.list([&] {
        at.expect('(');
        std::array<std::uint32_t, 3> t{};
        for (std::size_t k = 0; k < 3; ++k) {
          if (k > 0) at.expect(',');
          t[k] = corner();
        }
        at.expect(')');
        add(t, to);
      });
      return;
    }
    for (const bool fans : {false, true}) {
      if (fans) at.expect(',');
      at.list([&] {
        std::vector<std::uint32_t> c;
        at.list([&] { c.push_back(corner()); });
        for (std::size_t i = 2; i < c.size(); ++i)
          add(fans ? std::array{c[0], c[i - 1], c[i]} : std::array{c[i - 2 + i % 2], c[i - 1 - i % 2], c[i]}, to);
      });
    }
  }

  void add(const std::array<std::uint32_t, 3>& triangle, TriangleMesh& to) {
    if (++triangles_ > kMaxTrianglesPerByte * bytes_.size())
      refuse(path_, "damaged: its tessellated shapes name the same faces too often");
    to.triangles.push_back(triangle);
  }

  /// Index in `to` of a point of the file.
  std::uint32_t corner_of(std::uint64_t list, std::size_t point, const std::vector<Vec3>& points, TriangleMesh& to) {
    const auto [known, fresh] = corner_of_.emplace(list << 32 | point, static_cast<std::uint32_t>(to.vertices.size()));
    if (fresh) to.vertices.push_back(points[point]);
    return known->second;
  }

  const std::vector<Vec3>& points_of(std::uint64_t id) {
    const auto [known, fresh] = points_.try_emplace(id);
    if (!fresh) return known->second;
    const auto found = entities_.find(id);
    if (found == entities_.end() || found->second.kind != "COORDINATES_LIST")
      refuse(path_, "damaged: it has no COORDINATES_LIST #" + std::to_string(id));
    std::vector<Vec3>& points = known->second;
    StepCursor at = cursor(id, found->second.values);
    at.expect('(');
    at.skip();
    at.expect(',');
    at.skip();  // how many
    at.expect(',');
    at.list([&] {
      Vec3 p;
      at.expect('(');
      for (int k = 0; k < 3; ++k) {
        if (k > 0) at.expect(',');
        p[k] = at.number();
      }
      at.expect(')');
      points.push_back(p);
    });
    if (points.size() > std::numeric_limits<std::uint32_t>::max() / 4) at.damaged("has more than a billion points");
    return points;
  }

  const std::string& path_;
  std::string_view bytes_;
  const std::vector<StepStatement> statements_;
  std::unordered_map<std::uint64_t, Entity> entities_;
  std::set<std::uint64_t> items_;  // of representations
  std::map<std::uint64_t, std::vector<Vec3>> points_;
  std::unordered_map<std::uint64_t, std::uint32_t> corner_of_;  // of the shape that is being read
  std::uint64_t last_ = 0;
  std::size_t triangles_ = 0;
};

}  // namespace

bool mentions_triangles(std::string_view bytes) {
  return has(bytes, "TESSELLATED_") || has(bytes, "TRIANGULATED_");
}

PlainStep take_triangles(const std::string& path, std::string_view bytes) {
  return StepTriangleReader(path, bytes).read();
}

}  // namespace tegotae
