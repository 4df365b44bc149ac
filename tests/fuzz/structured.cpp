#include "fuzz/structured.hpp"

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

namespace tegotae {
namespace {

using nlohmann::json;

std::size_t below(std::size_t n, std::mt19937& random) {
  return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
}

template <typename T>
const T& one_of(const std::vector<T>& all, std::mt19937& random) {
  return all[below(all.size(), random)];
}

void collect(json& value, std::vector<json*>& all) {
  all.push_back(&value);
  if (value.is_structured())
    for (json& inside : value) collect(inside, all);
}

json other_number(const json& number, std::mt19937& random) {
  static const std::vector<json> kNumbers = {0,          1,          2,           3,          -1,   0.5,     1e-40,
                                             1e39,       1e300,      -1e300,      5120,       5126, 65535,   255,
                                             1000000000, 4294967295, 2147483648u, 1ull << 53, 1e19, 10000000};
  if (number.is_number_unsigned() && random() % 2 == 0)
    return number.get<std::uint64_t>() + (random() % 2 == 0 ? 1 : ~std::uint64_t{0});  // one more or less
  return one_of(kNumbers, random);
}

void mutate(json& top, std::mt19937& random) {
  static const std::vector<json> kOdd = {nullptr,          true, "",   "x", json::array(), json::object(),
                                         json::array({0}), -1,   1e300};
  std::vector<json*> all;
  collect(top, all);
  json& one = *one_of(all, random);
  json& other = *one_of(all, random);
  switch (below(6, random)) {
    case 0:  // whatever it is
      one = one_of(kOdd, random);
      return;
    case 1:  // a part of it is missing
      if (one.is_structured() && !one.empty())
        one.erase(std::next(one.begin(), static_cast<long>(below(one.size(), random))));
      return;
    case 2:  // or there twice
      if (one.is_array() && !one.empty())
        one.push_back(json(one_of(std::vector<json>(one.begin(), one.end()), random)));
      return;
    case 3:  // another's value, of the same kind as a rule
      if (one.type() == other.type() || random() % 8 == 0) one = json(other);
      return;
    default:
      break;
  }
  std::vector<json*> numbers;
  for (json* value : all)
    if (value->is_number()) numbers.push_back(value);
  if (numbers.empty()) return;
  json& number = *one_of(numbers, random);
  number = other_number(number, random);
}

std::string mutated_json(const std::string& text, std::mt19937& random) {
  json top = json::parse(text, nullptr, false);
  if (top.is_discarded()) return text;
  mutate(top, random);
  return top.dump(-1, ' ', false, json::error_handler_t::replace);
}

void put(std::string& bytes, std::uint32_t word) {
  bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

/// The same with another JSON chunk, and now and then another binary one or chunks of other kinds.
std::string mutated_glb(const std::string& bytes, std::mt19937& random) {
  constexpr std::size_t kHeader = 12, kChunk = 8;
  std::uint32_t size = 0;
  if (bytes.size() < kHeader + kChunk) return bytes;
  std::memcpy(&size, bytes.data() + kHeader, sizeof size);
  if (size > bytes.size() - kHeader - kChunk) return bytes;
  std::string text = bytes.substr(kHeader + kChunk, size), rest = bytes.substr(kHeader + kChunk + size);
  switch (below(8, random)) {
    case 0:
      if (!rest.empty()) rest[below(rest.size(), random)] = static_cast<char>(random());
      break;
    case 1:
      if (rest.size() > kChunk) rest.replace(4, 3, "XYZ");
      break;
    case 2:
      rest.resize(below(rest.size() + 1, random));
      break;
    default:
      text = mutated_json(text, random);
  }
  while (text.size() % 4 != 0) text += ' ';
  std::string out = "glTF";
  put(out, 2);
  put(out, static_cast<std::uint32_t>(kHeader + kChunk + text.size() + rest.size()));
  put(out, static_cast<std::uint32_t>(text.size()));
  return out + "JSON" + text + rest;
}

/// Where something of XML text begins and how long it is.
using Piece = std::pair<std::size_t, std::size_t>;

/// What stands between two of `mark`, without them.
std::vector<Piece> values_of(const std::string& text, char mark) {
  std::vector<Piece> all;
  for (std::size_t from = text.find(mark); from != text.npos;) {
    const std::size_t to = text.find(mark, from + 1);
    if (to == text.npos) break;
    all.emplace_back(from + 1, to - from - 1);
    from = text.find(mark, to + 1);
  }
  return all;
}

std::vector<Piece> tags_of(const std::string& text) {
  std::vector<Piece> all;
  for (std::size_t from = text.find('<'); from != text.npos; from = text.find('<', from + 1)) {
    const std::size_t to = text.find('>', from);
    if (to != text.npos) all.emplace_back(from, to + 1 - from);
  }
  return all;
}

std::string mutated_xml(std::string text, std::mt19937& random) {
  static const std::vector<std::string> kValues = {"",
                                                   "0",
                                                   "1",
                                                   "2",
                                                   "3",
                                                   "-1",
                                                   "0.5",
                                                   "nan",
                                                   "inf",
                                                   "1e300",
                                                   "-1e300",
                                                   "1e999",
                                                   "1,5",
                                                   "0x10",
                                                   " 1 ",
                                                   "4294967296",
                                                   "99999999999999999999",
                                                   "1 0 0 0 1 0 0 0 1 0 0 0",
                                                   "0 0 0 0 0 0 0 0 0 0 0 0",
                                                   "nan 0 0 0 1 0 0 0 1 0 0 0",
                                                   "1e200 0 0 0 1e200 0 0 0 1e200 0 0 0",
                                                   "micron",
                                                   "furlong",
                                                   "support",
                                                   "other",
                                                   "a&#10;b",
                                                   "/m",
                                                   "/none"};
  const auto values = values_of(text, '\'');
  const auto tags = tags_of(text);
  if (values.empty() || tags.empty()) return text;
  const Piece value = one_of(values, random), other = one_of(values, random);
  const Piece tag = one_of(tags, random), second = one_of(tags, random);
  switch (below(7, random)) {
    case 0:
      return text.replace(value.first, value.second, text.substr(other.first, other.second));
    case 1: {  // an attribute is missing
      const std::size_t name = text.rfind(' ', value.first);
      if (name == text.npos) return text;
      return text.erase(name, value.first + value.second + 1 - name);
    }
    case 2:
      return text.erase(tag.first, tag.second);
    case 3:
      return text.insert(tag.first, text.substr(second.first, second.second));
    case 4:  // an element with all that is in it, if its end is the other tag
      if (tag.first > second.first) return text;
      return text.insert(second.first + second.second,
                         text.substr(tag.first, second.first + second.second - tag.first));
    default:
      return text.replace(value.first, value.second, one_of(kValues, random));
  }
}

}  // namespace

std::string structured_mutation(const std::string& bytes, Grammar grammar, std::mt19937& random) {
  if (grammar == Grammar::json) return mutated_json(bytes, random);
  if (grammar == Grammar::glb) return mutated_glb(bytes, random);
  return grammar == Grammar::xml ? mutated_xml(bytes, random) : bytes;
}

}  // namespace tegotae
