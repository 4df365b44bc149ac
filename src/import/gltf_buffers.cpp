#include "import/gltf_buffers.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace tegotae {
namespace {

using nlohmann::json;

// A file with more text than this has its data in it.
constexpr std::uintmax_t kMaxText = 64u << 20;

/// The JSON of a file of either kind; nothing where there is too much of it.
std::string json_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::error_code failed;
  std::uintmax_t size = std::filesystem::file_size(path, failed);
  std::array<char, 20> header{};
  if (failed || !file) return {};
  if (file.read(header.data(), header.size()) && std::memcmp(header.data(), "glTF", 4) == 0) {
    std::uint32_t length = 0;  // of the first chunk, which is the JSON
    std::memcpy(&length, header.data() + 12, sizeof length);
    size = std::min<std::uintmax_t>(length, size);
  } else {
    file.clear();
    file.seekg(0);
  }
  if (size > kMaxText) return {};
  std::string text(size, '\0');
  file.read(text.data(), static_cast<std::streamsize>(size));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

}  // namespace

std::string decoded_uri(const std::string& uri) {
  std::string out;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && std::isxdigit(static_cast<unsigned char>(uri[i + 1])) != 0 &&
        std::isxdigit(static_cast<unsigned char>(uri[i + 2])) != 0) {
      out.push_back(static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16)));
      i += 2;
    } else {
      out.push_back(uri[i]);
    }
  }
  return out;
}

std::vector<std::string> gltf_buffer_files(const std::string& path) {
  std::vector<std::string> files;
  const json top = json::parse(json_text(path), nullptr, false);
  if (!top.is_object() || !top.contains("buffers")) return files;
  for (const json& buffer : top["buffers"]) {
    if (!buffer.is_object() || !buffer.contains("uri") || !buffer["uri"].is_string()) continue;
    const auto uri = buffer["uri"].get<std::string>();
    if (uri.rfind("data:", 0) != 0)
      files.push_back((std::filesystem::path(path).parent_path() / decoded_uri(uri)).string());
  }
  return files;
}

}  // namespace tegotae
