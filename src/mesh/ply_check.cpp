#include "mesh/ply_check.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <sstream>
#include <utility>
#include <vector>

#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(path + ": " + why);
}

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

template <class T>
bool is_a(double value) {
  return value >= std::numeric_limits<T>::lowest() && value <= std::numeric_limits<T>::max() &&
         value == std::floor(value);
}

bool fits(Scalar type, double value) {
  switch (type) {
    case Scalar::i8:
      return is_a<std::int8_t>(value);
    case Scalar::u8:
      return is_a<std::uint8_t>(value);
    case Scalar::i16:
      return is_a<std::int16_t>(value);
    case Scalar::u16:
      return is_a<std::uint16_t>(value);
    case Scalar::i32:
      return is_a<std::int32_t>(value);
    case Scalar::u32:
      return is_a<std::uint32_t>(value);
    default:
      return true;
  }
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

  /// The next value; false at the end of the bytes or of an ASCII file's line, and at a word that is no number of this
  /// type.
  bool next(Scalar type, double& value) {
    return encoding_ == Encoding::ascii ? word(value) && fits(type, value) : binary(type, value);
  }

  /// To the next element. False when values are left over on an ASCII file's line: assimp takes a line for an element,
  /// and would read others than those that were checked.
  bool end_element() {
    if (encoding_ != Encoding::ascii) return true;
    skip_blanks();
    if (at_ < bytes_.size() && bytes_[at_] != '\n') return false;
    at_ = std::min(at_ + 1, bytes_.size());
    return true;
  }

  std::size_t left() const { return bytes_.size() - at_; }

 private:
  void skip_blanks() { at_ = std::min(bytes_.find_first_not_of(" \t\r", at_), bytes_.size()); }

  bool word(double& value) {
    skip_blanks();
    const std::size_t end = std::min(bytes_.find_first_of(" \t\r\n", at_), bytes_.size());
    const auto [stop, error] = std::from_chars(bytes_.data() + at_, bytes_.data() + end, value);
    // A number too large for a double is a number; the coordinates are judged after loading.
    const bool good = end > at_ && error != std::errc::invalid_argument && stop == bytes_.data() + end;
    at_ = end;
    return good;
  }

  template <class T>
  bool take(double& value) {
    if (left() < sizeof(T)) return false;
    char raw[sizeof(T)];
    std::copy_n(bytes_.data() + at_, sizeof(T), raw);
    at_ += sizeof(T);
    // The machines this runs on are little-endian.
    if (encoding_ == Encoding::big) std::reverse(raw, raw + sizeof(T));
    T number;
    std::memcpy(&number, raw, sizeof(T));
    value = static_cast<double>(number);
    return true;
  }

  bool binary(Scalar type, double& value) {
    switch (type) {
      case Scalar::i8:
        return take<std::int8_t>(value);
      case Scalar::u8:
        return take<std::uint8_t>(value);
      case Scalar::i16:
        return take<std::int16_t>(value);
      case Scalar::u16:
        return take<std::uint16_t>(value);
      case Scalar::i32:
        return take<std::int32_t>(value);
      case Scalar::u32:
        return take<std::uint32_t>(value);
      case Scalar::f32:
        return take<float>(value);
      case Scalar::f64:
        return take<double>(value);
      case Scalar::none:
        break;
    }
    return false;
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
    if ((code < 32 && c != '\t') || (code > 126 && !comment)) refuse(path, "damaged: its header is no plain text");
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
  const auto [end, error] = std::from_chars(line[2].data(), line[2].data() + line[2].size(), element.count);
  if (error != std::errc() || end != line[2].data() + line[2].size())
    refuse(path, "damaged: the count of element " + element.name + " is no number");
  // Of strips, assimp believes every length; of elements that it does not know it takes the name for the count.
  if (element.name != "vertex" && element.name != "face" && element.name != "edge" && element.name != "material")
    refuse(path, "element " + element.name + " is not supported: export vertices and faces alone");
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
  if (property.value == Scalar::none || (list && property.length == Scalar::none))
    refuse(path, "damaged: a property of the header has no known type and name");
  return property;
}

Header read_header(const std::string& path, std::string_view bytes) {
  Header header;
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

/// What assimp takes for granted of elements and properties that it knows.
void check_elements(const std::string& path, const Header& header) {
  for (const Element& element : header.elements) {
    const auto same = [&](const Element& e) { return e.name == element.name; };
    if (std::count_if(header.elements.begin(), header.elements.end(), same) > 1)
      refuse(path, "damaged: its header has element " + element.name + " twice");
    for (const Property& property : element.properties) {
      const auto same_name = [&](const Property& p) { return p.name == property.name; };
      if (std::count_if(element.properties.begin(), element.properties.end(), same_name) > 1)
        refuse(path, "damaged: its header has property " + property.name + " of " + element.name + " twice");
    }
    const auto list = [](const Property& p) { return p.length != Scalar::none; };
    if (element.name == "vertex" && std::any_of(element.properties.begin(), element.properties.end(), list))
      refuse(path, "damaged: its vertices have lists");
    // Texture coordinates of faces without corners are read through a null pointer.
    if (element.name == "face" && element.count > 0 &&
        std::none_of(element.properties.begin(), element.properties.end(), has_corners))
      refuse(path, "damaged: its faces have no list vertex_indices or vertex_index");
  }
}

}  // namespace

void check_ply(const std::string& path, std::string_view bytes) {
  const Header header = read_header(path, bytes);
  check_elements(path, header);
  std::uint64_t vertices = 0;
  for (const Element& element : header.elements) {
    if (element.name == "vertex") vertices = element.count;
  }
  Body body(bytes.substr(header.size), header.encoding);
  for (const Element& element : header.elements) {
    // Every element takes at least a byte, so a count that the file cannot hold is found without counting to it.
    if (!element.properties.empty() && element.count > body.left()) {
      refuse(path, "truncated: " + std::to_string(element.count) + " of element " + element.name +
                       " are announced, more than the file has bytes");
    }
    if (element.properties.empty()) continue;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const auto place = [&] { return element.name + ' ' + std::to_string(i); };
      for (const Property& property : element.properties) {
        const bool list = property.length != Scalar::none;
        const bool corners = has_corners(property);
        double length = 1;
        if (list && (!body.next(property.length, length) || !is_a<std::uint32_t>(length)))
          refuse(path, "truncated or damaged at " + place());
        for (double k = 0; k < length; ++k) {
          double value = 0;
          if (!body.next(property.value, value)) refuse(path, "truncated or damaged at " + place());
          if (corners && !(value >= 0 && value < static_cast<double>(vertices))) {
            refuse(path, "index out of range: " + place() + " names vertex " + std::to_string(std::llround(value)) +
                             " of " + std::to_string(vertices));
          }
        }
      }
      if (!body.end_element()) refuse(path, "damaged: more values on its line than " + place() + " has");
    }
  }
}

}  // namespace tegotae
