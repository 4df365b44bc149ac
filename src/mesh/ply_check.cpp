#include "mesh/ply_check.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
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

Header read_header(const std::string& path, std::string_view bytes) {
  Header header;
  bool first = true, has_format = false;
  while (header.size < bytes.size()) {
    const std::size_t end = bytes.find('\n', header.size);
    if (end == std::string_view::npos) break;
    std::istringstream line{std::string(bytes.substr(header.size, end - header.size))};
    header.size = end + 1;
    std::string word;
    line >> word;
    if (first && word != "ply") refuse(path, "damaged: it does not begin with ply");
    first = false;
    if (word == "end_header") {
      if (!has_format) break;
      return header;
    }
    if (word == "format") {
      line >> word;
      has_format = word == "ascii" || word == "binary_little_endian" || word == "binary_big_endian";
      header.encoding = word == "ascii"                  ? Body::Encoding::ascii
                        : word == "binary_little_endian" ? Body::Encoding::little
                                                         : Body::Encoding::big;
    } else if (word == "element") {
      Element element;
      line >> element.name >> element.count;
      if (!line) refuse(path, "damaged: an element of the header has no count");
      header.elements.push_back(element);
    } else if (word == "property") {
      Property property;
      line >> word;
      if (word == "list") {
        line >> word;
        property.length = scalar_of(word);
        if (property.length == Scalar::none) refuse(path, "damaged: unknown type " + word + " in the header");
        line >> word;
      }
      property.value = scalar_of(word);
      line >> property.name;
      if (property.value == Scalar::none) refuse(path, "damaged: unknown type " + word + " in the header");
      if (header.elements.empty()) refuse(path, "damaged: a property before the first element");
      header.elements.back().properties.push_back(property);
    } else if (word != "ply" && word != "comment" && word != "obj_info" && !word.empty()) {
      refuse(path, "damaged: unknown word in the header");
    }
  }
  refuse(path, "truncated or damaged header");
}

bool has_corners(const Property& property) {
  return property.length != Scalar::none && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// Faces must say their corners: assimp reads texture coordinates of those that do not through a null pointer.
void check_faces(const std::string& path, const Header& header) {
  for (const Element& element : header.elements)
    if (element.name == "face" && element.count > 0 &&
        std::none_of(element.properties.begin(), element.properties.end(), has_corners))
      refuse(path, "damaged: its faces have no list vertex_indices or vertex_index");
}

}  // namespace

void check_ply(const std::string& path, std::string_view bytes) {
  const Header header = read_header(path, bytes);
  check_faces(path, header);
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
