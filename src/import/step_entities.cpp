#include "import/step_entities.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "import/check_text.hpp"

namespace tegotae {
namespace {

// Entities are numbered by an int in OpenCASCADE; what is added to a file needs some numbers too.
constexpr std::uint64_t kLargestId = 2'000'000'000;

/// How many signs at the start of `text` stand together: a text 'it''s', a comment, or one sign. 0: it has no end.
std::size_t unit(std::string_view text) {
  std::size_t end = 0;
  if (text[0] == '\'' || text[0] == '"')
    end = text.find(text[0], 1);
  else if (text.substr(0, 2) == "/*")
    end = text.find("*/", 2) == std::string_view::npos ? std::string_view::npos : text.find("*/", 2) + 1;
  return end == std::string_view::npos ? 0 : end + 1;
}

}  // namespace

void StepCursor::damaged(const std::string& why) const {
  refuse(path_, "damaged: #" + std::to_string(id_) + " " + why);
}

void StepCursor::skip_blank() {
  for (;;) {
    text_.remove_prefix(std::min(text_.find_first_not_of(kBlank), text_.size()));
    if (text_.substr(0, 2) != "/*") return;
    text_.remove_prefix(std::max<std::size_t>(unit(text_), 1));
  }
}

bool StepCursor::take(char c) {
  skip_blank();
  if (text_.empty() || text_[0] != c) return false;
  text_.remove_prefix(1);
  return true;
}

void StepCursor::expect(char c) {
  if (!take(c)) damaged(std::string("has no \"") + c + "\" where one belongs");
}

std::string_view StepCursor::word() {
  skip_blank();
  const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '!'; };
  const auto end = std::find_if_not(text_.begin(), text_.end(), in_word);
  const std::string_view word = text_.substr(0, static_cast<std::size_t>(end - text_.begin()));
  text_.remove_prefix(word.size());
  return word;
}

double StepCursor::number() {
  skip_blank();
  if (text_.size() > 1 && text_[0] == '+' && text_[1] != '-') text_.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
  if (error != std::errc() || !std::isfinite(value)) damaged("has a coordinate that is not a number");
  text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
  return value;
}

std::uint64_t StepCursor::index() {
  skip_blank();
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text_.data(), text_.data() + text_.size(), value);
  if (error != std::errc() || value == 0) damaged("has an index that is not a whole number from 1 on");
  text_.remove_prefix(static_cast<std::size_t>(end - text_.data()));
  return value;
}

std::uint64_t StepCursor::reference() {
  expect('#');
  return index();
}

std::uint64_t StepCursor::optional() {
  return take('$') || take('*') ? 0 : reference();
}

void StepCursor::skip() {
  std::size_t depth = 0;
  do {
    skip_blank();
    if (text_.empty()) damaged("ends too early");
    const char c = text_[0];
    if (depth == 0 && (c == ',' || c == ')')) damaged("lacks a value");
    depth += c == '(';
    depth -= c == ')';
    text_.remove_prefix(std::max<std::size_t>(unit(text_), 1));
    skip_blank();
  } while (depth > 0 || (!text_.empty() && text_[0] != ',' && text_[0] != ')'));
}

bool StepCursor::at_end() {
  skip_blank();
  return text_.empty();
}

std::string_view StepCursor::rest() {
  skip_blank();
  return text_;
}

std::vector<StepStatement> step_statements(const std::string& path, std::string_view bytes) {
  std::vector<StepStatement> out;
  std::size_t start = 0;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t n = unit(bytes.substr(at));
    if (n == 0) refuse(path, "damaged: a text or comment in it has no end");
    at += n;
    if (bytes[at - 1] != ';' || n > 1) continue;
    StepStatement s;
    s.text = bytes.substr(start, at - start);
    StepCursor cursor(path, 0, s.text.substr(0, s.text.size() - 1));
    if (cursor.take('#')) {
      s.id = cursor.index();
      if (s.id > kLargestId)
        refuse(path, "damaged: the number of the entity #" + std::to_string(s.id) + " is too large");
      cursor.expect('=');
      s.value = cursor.rest();
    }
    out.push_back(s);
    start = at;
  }
  if (start < bytes.size()) out.push_back({0, bytes.substr(start), {}});
  return out;
}

namespace {

std::string without_comments(const std::string& path, std::string_view bytes) {
  std::string out;
  out.reserve(bytes.size());
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t n = unit(bytes.substr(at));
    if (n == 0) refuse(path, "damaged: a text or comment in it has no end");
    if (bytes.substr(at, 2) == "/*")
      out += ' ';
    else
      out += bytes.substr(at, n);
    at += n;
  }
  return out;
}

}  // namespace

std::string plain_step(const std::string& path, std::string bytes) {
  if (bytes.compare(0, 3, "\xef\xbb\xbf") == 0) bytes.erase(0, 3);
  const auto has = [&](const char* text) { return bytes.find(text) != std::string::npos; };
  if (has("/*")) bytes = without_comments(path, bytes);
  if (!has("DATA(") && !has("DATA (") && !has("ANCHOR;") && !has("REFERENCE;")) return bytes;
  std::string out, section, data;
  for (const StepStatement& s : step_statements(path, bytes)) {
    StepCursor cursor(path, 0, s.text);
    const std::string word(s.id == 0 ? cursor.word() : std::string_view());
    if (word == "REFERENCE") refuse(path, "it refers to entities of other files (REFERENCE), which are not read");
    if (word == "ANCHOR" || word == "DATA") {
      section = word;
    } else if (!section.empty()) {
      if (word == "ENDSEC")
        section.clear();
      else if (section == "DATA")
        data += s.text;
    } else {
      if (word == "END") out += "\nDATA;" + data + "\nENDSEC;";
      out += s.text;
    }
  }
  return out;
}

}  // namespace tegotae
