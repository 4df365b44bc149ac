#include "import/plain_ply.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <set>
#include <sstream>
#include <type_traits>
#include <vector>

#include "import/check_text.hpp"
#include "import/ply_bytes.hpp"

namespace tegotae {
namespace {

enum class Scalar { none, i8, u8, i16, u16, i32, u32, f32, f64 };

Scalar scalar_of(const std::string& name) {
  if (name == "char" || name == "int8") return Scalar::i8;
  if (name == "uchar" || name == "uint8") return Scalar::u8;
  if (name == "short" || name == "int16") return Scalar::i16;
  if (name == "ushort" || name == "uint16") return Scalar::u16;
  if (name == "int" || name == "int32") return Scalar::i32;
  if (name == "uint" || name == "uint32") return Scalar::u32;
  if (name == "float" || name == "float32") return Scalar::f32;
  if (name == "double" || name == "float64") return Scalar::f64;
  return Scalar::none;
}

/// visit() of a zero of the C++ type; of none it is false.
template <class Visit>
bool with_type(Scalar type, Visit visit) {
  switch (type) {
    case Scalar::i8:
      return visit(std::int8_t{});
    case Scalar::u8:
      return visit(std::uint8_t{});
    case Scalar::i16:
      return visit(std::int16_t{});
    case Scalar::u16:
      return visit(std::uint16_t{});
    case Scalar::i32:
      return visit(std::int32_t{});
    case Scalar::u32:
      return visit(std::uint32_t{});
    case Scalar::f32:
      return visit(float{});
    case Scalar::f64:
      return visit(double{});
    case Scalar::none:
      break;
  }
  return false;
}

/// Whether a text may stand for a T: too large for a float is for the judge of coordinates.
template <class T>
bool fits(double value, T) {
  if constexpr (std::is_floating_point_v<T>) return true;
  return value >= std::numeric_limits<T>::lowest() && value <= std::numeric_limits<T>::max() &&
         value == std::floor(value);
}

struct Property {
  Scalar length = Scalar::none;  ///< of a list's count; none for a single value
  Scalar value = Scalar::none;
  std::string name;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

/// One value after the other of the body, in any of the three encodings.
class Body {
 public:
  enum class Encoding { ascii, little, big };
  Body(std::string_view bytes, Encoding encoding) : bytes_(bytes), encoding_(encoding) {}

  /// The next value; false at the end of the bytes or of an ASCII file's line, and at a word that is not a number of
  /// this type.
  bool next(Scalar type, double& value) {
    if (encoding_ != Encoding::ascii) return with_type(type, [&](auto zero) { return take(value, zero); });
    std::string_view rest = bytes_.substr(at_);
    const bool number = take_coordinate(rest, value);
    at_ = bytes_.size() - rest.size();
    return number && with_type(type, [&](auto zero) { return fits(value, zero); });
  }

  /// To the line of the next element, in an ASCII file.
  void begin_element() {
    if (encoding_ == Encoding::ascii) at_ = first_not_of(bytes_, kBlank, at_);
  }

  /// False when values are left over on an ASCII file's line, which is an element.
  bool end_element() {
    if (encoding_ != Encoding::ascii) return true;
    at_ = first_not_of(bytes_, " \t\r", at_);
    return at_ == bytes_.size() || bytes_[at_] == '\n';
  }

  std::string_view rest() const { return bytes_.substr(at_); }
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  template <class T>
  bool take(double& value, T number) {
    if (left() < sizeof(T)) return false;
    char raw[sizeof(T)];
    std::copy_n(bytes_.data() + at_, sizeof(T), raw);
    at_ += sizeof(T);
    // The machines this runs on are little-endian.
    if (encoding_ == Encoding::big) std::reverse(raw, raw + sizeof(T));
    std::memcpy(&number, raw, sizeof(T));
    value = static_cast<double>(number);
    return true;
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  Encoding encoding_;
};

struct Header {
  Body::Encoding encoding = Body::Encoding::ascii;
  std::vector<Element> elements;
  std::size_t size = 0;  ///< bytes up to the body
};

using Words = std::vector<std::string>;

/// The next line of the header, in words; a comment's are not told. Anything that another reader might take for the end
/// of a line or of the text is refused.
Words next_line(const std::string& path, std::string_view bytes, std::size_t& at) {
  const std::size_t end = bytes.find('\n', at);
  if (end == std::string_view::npos) refuse(path, "truncated or damaged header");
  std::string line(bytes.substr(at, end - at));
  at = end + 1;
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::istringstream words(line);
  Words all{std::istream_iterator<std::string>(words), {}};
  const bool comment = !all.empty() && (all[0] == "comment" || all[0] == "obj_info");
  for (const char c : line) {
    const auto code = static_cast<unsigned char>(c);
    if ((code < 32 && c != '\t') || (code > 126 && !comment)) refuse(path, "damaged: its header is not plain text");
  }
  if (comment) all.resize(1);
  return all;
}

/// "format ENCODING 1.0"
Body::Encoding read_encoding(const std::string& path, const Words& line) {
  if (line.size() == 3 && line[2] == "1.0") {
    if (line[1] == "ascii") return Body::Encoding::ascii;
    if (line[1] == "binary_little_endian") return Body::Encoding::little;
    if (line[1] == "binary_big_endian") return Body::Encoding::big;
  }
  refuse(path, "damaged: its format is not ascii, binary_little_endian or binary_big_endian 1.0");
}

/// "element NAME COUNT"
Element read_element(const std::string& path, const Words& line) {
  Element element;
  if (line.size() != 3) refuse(path, "damaged: an element of the header is not \"element NAME COUNT\"");
  element.name = line[1];
  std::string_view count = line[2];
  if (!take_number(count, element.count))
    refuse(path, "damaged: the count of element " + element.name + " is not a number");
  return element;
}

/// "property TYPE NAME" or "property list TYPE TYPE NAME"
Property read_property(const std::string& path, const Words& line) {
  Property property;
  const bool list = line.size() == 5 && line[1] == "list";
  if (list) property.length = scalar_of(line[2]);
  if (list || line.size() == 3) {
    property.value = scalar_of(line[line.size() - 2]);
    property.name = line.back();
  }
  if (property.value == Scalar::none || (list && property.length == Scalar::none)) {
    std::string text;
    for (const std::string& word : line) text += (text.empty() ? "" : " ") + word;
    refuse(path, "damaged: \"" + text.substr(0, 60) + "\" in its header has no known type and name");
  }
  return property;
}

Header read_header(const std::string& path, std::string_view bytes) {
  Header header;
  require_single_bytes(path, bytes);
  if (bytes.substr(0, 3) == "\xef\xbb\xbf") header.size = 3;
  if (next_line(path, bytes, header.size) != Words{"ply"}) refuse(path, "damaged: it does not begin with ply");
  bool has_format = false;
  for (;;) {
    const Words line = next_line(path, bytes, header.size);
    if (line.empty() || line[0] == "comment" || line[0] == "obj_info") continue;
    if (line[0] == "format" && !has_format) {
      header.encoding = read_encoding(path, line);
      has_format = true;
    } else if (!has_format) {
      refuse(path, "damaged: its header does not begin with its format");
    } else if (line == Words{"end_header"}) {
      return header;
    } else if (line[0] == "element") {
      header.elements.push_back(read_element(path, line));
    } else if (line[0] == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(read_property(path, line));
    } else {
      refuse(path, "damaged: its header has a line that begins with neither element nor property");
    }
  }
}

bool has_corners(const Property& property) {
  return property.length != Scalar::none && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// What has one meaning only: names given once, faces with corners, vertices with places.
void check_elements(const std::string& path, const Header& header) {
  for (const Element& element : header.elements) {
    const auto same = [&](const Element& e) { return e.name == element.name; };
    if (std::count_if(header.elements.begin(), header.elements.end(), same) > 1)
      refuse(path, "damaged: its header has element " + element.name + " twice");
    if (element.count > 0 && element.properties.empty())
      refuse(path, "damaged: element " + element.name + " of its header has no properties");
    std::set<std::string> names;
    for (const Property& property : element.properties)
      if (!names.insert(property.name).second)
        refuse(path, "damaged: its header has property " + property.name + " of " + element.name + " twice");
    for (const char* axis : {"x", "y", "z"}) {
      const auto is_axis = [&](const Property& p) { return p.name == axis && p.length == Scalar::none; };
      if (element.name == "vertex" && std::none_of(element.properties.begin(), element.properties.end(), is_axis))
        refuse(path, std::string("damaged: its vertices have no ") + axis);
    }
    if ((element.name == "face" || element.name == "tristrips") && element.count > 0 &&
        std::none_of(element.properties.begin(), element.properties.end(), has_corners))
      refuse(path, "damaged: element " + element.name + " has no list vertex_indices or vertex_index");
  }
}

/// Reads the body, and writes what is shape of it.
class PlyReader {
 public:
  PlyReader(const std::string& path, std::string_view bytes)
      : path_(path), header_(read_header(path, bytes)), body_(bytes.substr(header_.size), header_.encoding) {
    check_elements(path, header_);
    for (const Element& element : header_.elements)
      if (element.name == "vertex") vertices_ = element.count;
  }

  std::string plain(std::vector<std::string>& notes) {
    for (const Element& element : header_.elements) {
      // Every element takes at least a byte, so a count that the file cannot hold is found without counting to it.
      if (element.count > body_.left()) {
        refuse(path_, "truncated: " + std::to_string(element.count) + " of element " + element.name +
                          " are announced, more than the file has bytes");
      }
      for (std::uint64_t i = 0; i < element.count; ++i) read(element, i);
    }
    if (!is_padding(body_.rest()))
      notes.push_back(
          "what stands behind its last element is not read: its header announces fewer elements; correct it "
          "if something is missing");
    out_.note_short(notes);
    if (!out_.has_faces()) refuse(path_, "no triangles");
    return out_.file();
  }

 private:
  void read(const Element& element, std::uint64_t number) {
    const auto place = [&] { return element.name + ' ' + std::to_string(number); };
    Vec3 p = Vec3::Zero();
    body_.begin_element();
    for (const Property& property : element.properties) {
      read(property, place);
      if (element.name == "vertex" && property.length == Scalar::none && property.name.size() == 1 &&
          property.name[0] >= 'x' && property.name[0] <= 'z')
        p[property.name[0] - 'x'] = values_[0];
      if (element.name == "face" && has_corners(property)) add_face(place);
      if (element.name == "tristrips" && has_corners(property)) add_strips(place);
    }
    if (element.name == "vertex") out_.vertex(p);
    if (!body_.end_element()) refuse(path_, "damaged: more values on its line than " + place() + " has");
  }

  /// One property of one element into `values_`; `place` says which.
  template <class Place>
  void read(const Property& property, Place place) {
    double length = 1, value = 0;
    if (property.length != Scalar::none && (!body_.next(property.length, length) || !fits(length, std::uint32_t{})))
      refuse(path_, "truncated or damaged at " + place());
    values_.clear();
    for (double k = 0; k < length; ++k) {
      if (!body_.next(property.value, value)) refuse(path_, "truncated or damaged at " + place());
      values_.push_back(value);
    }
  }

  template <class Place>
  std::uint32_t vertex(double value, Place place) const {
    if (value != std::floor(value)) refuse(path_, "damaged: " + place() + " has an index that is not a whole number");
    if (!(value >= 0 && value < static_cast<double>(vertices_))) {
      refuse(path_, "index out of range: " + place() + " names vertex " + std::to_string(std::llround(value)) + " of " +
                        std::to_string(vertices_));
    }
    return static_cast<std::uint32_t>(value);
  }

  template <class Place>
  void add_face(Place place) {
    std::vector<std::uint32_t> corners;
    for (const double value : values_) corners.push_back(vertex(value, place));
    out_.face(corners);
  }

  /// Strips of triangles, one after the other; -1 ends one.
  template <class Place>
  void add_strips(Place place) {
    std::vector<std::uint32_t> strip;
    for (const double value : values_) {
      if (value == -1) {
        strip.clear();
        continue;
      }
      strip.push_back(vertex(value, place));
      const std::size_t n = strip.size();
      if (n < 3 || strip[n - 1] == strip[n - 2] || strip[n - 2] == strip[n - 3] || strip[n - 3] == strip[n - 1])
        continue;
      const bool odd = n % 2 == 1;
      out_.face({strip[n - 3], strip[odd ? n - 2 : n - 1], strip[odd ? n - 1 : n - 2]});
    }
  }

  const std::string& path_;
  Header header_;
  Body body_;
  std::uint64_t vertices_ = 0;
  std::vector<double> values_;
  PlyBytes out_;
};

/// Whether the lines end as on the machines of the format's first years, by a carriage return alone.
bool has_old_ends(std::string_view bytes) {
  const std::size_t end = first_of(bytes, "\r\n");
  return bytes.substr(end, 1) == "\r" && bytes.substr(end + 1, 1) != "\n";
}

/// Those of the header and, where it is text, of the body become line feeds.
std::string with_new_ends(std::string_view bytes) {
  constexpr std::string_view kEnd = "end_header\r";
  std::string out(bytes);
  const std::size_t found = bytes.find(kEnd);
  const std::size_t end = found == bytes.npos ? bytes.size() : found + kEnd.size();
  const bool text = bytes.substr(0, end).find("format ascii") != bytes.npos;
  std::replace(out.begin(), text ? out.end() : out.begin() + static_cast<std::ptrdiff_t>(end), '\r', '\n');
  return out;
}

}  // namespace

std::string plain_ply(const std::string& path, std::string_view bytes, std::vector<std::string>& notes) {
  if (!has_old_ends(bytes)) return PlyReader(path, bytes).plain(notes);
  const std::string plain = with_new_ends(bytes);
  return PlyReader(path, plain).plain(notes);
}

}  // namespace tegotae
