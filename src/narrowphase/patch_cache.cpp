#include "narrowphase/patch_cache.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <optional>

#include "tegotae/narrowphase/hierarchy_cache.hpp"

namespace tegotae {

namespace fs = std::filesystem;

namespace {

// To be raised whenever PatchTree builds another tree over the same mesh.
constexpr std::uint32_t kBuild = 1;
constexpr std::uintmax_t kMaxBytes = std::uintmax_t{4} << 30;  // in the folder; the oldest files go first

std::string& folder() {
  static std::string path;
  return path;
}

using Key = std::array<std::uint64_t, 2>;

/// Two independent sums of 64 bits over words.
class Sum {
 public:
  void add(const void* data, std::size_t bytes) {
    const char* at = static_cast<const char*>(data);
    for (; bytes >= 8; bytes -= 8, at += 8) {
      std::uint64_t word;
      std::memcpy(&word, at, 8);
      mix(word);
    }
    if (bytes == 0) return;
    std::uint64_t word = 0;
    std::memcpy(&word, at, bytes);
    mix(word);
  }
  const Key& key() const { return sums_; }

 private:
  void mix(std::uint64_t word) {
    sums_[0] = (sums_[0] ^ word) * 0x9e3779b97f4a7c15ull;
    sums_[0] ^= sums_[0] >> 32;
    sums_[1] = (sums_[1] + word) * 0xd6e8feb86659fd93ull;
    sums_[1] ^= sums_[1] >> 29;
  }
  Key sums_{0x2545f4914f6cdd1dull, 0x632be59bd9b4e019ull};
};

/// Fixed size, no padding.
struct Header {
  std::array<char, 8> magic{'T', 'G', 'T', 'P', 'A', 'T', 'C', 'H'};
  std::uint32_t build = kBuild, leaf = kPatchLeaf;
  std::uint32_t node_bytes = sizeof(PatchNode), byte_order = 0x01020304;
  Key mesh{};
  std::uint64_t triangles = 0, nodes = 0;
  std::array<double, 3> origin{};
  double radius = 0;
};
static_assert(sizeof(Header) == 88 && std::is_trivially_copyable_v<PatchNode>);

Key key_of(const TriangleMesh& mesh) {
  Sum sum;
  sum.add(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3));
  sum.add(mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  return sum.key();
}

fs::path file_of(const Key& key) {
  char name[48];
  std::snprintf(name, sizeof name, "%016llx%016llx.patch", static_cast<unsigned long long>(key[0]),
                static_cast<unsigned long long>(key[1]));
  return fs::path(folder()) / name;
}

/// Whether every index leads somewhere, children lie behind their parents, and the leaves hold each face once.
bool is_sound(const std::vector<PatchNode>& nodes, const std::vector<std::uint32_t>& order) {
  std::vector<bool> seen(order.size(), false);
  for (const std::uint32_t face : order) {
    if (face >= order.size() || seen[face]) return false;
    seen[face] = true;
  }
  std::uint64_t places = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const PatchNode& n = nodes[i];
    places += n.count;
    if (n.leaf() ? std::uint64_t{n.first} + n.count > order.size()
                 : n.first <= i || std::uint64_t{n.first} + 2 > nodes.size())
      return false;
  }
  return places == order.size();
}

template <typename T>
bool read(std::ifstream& file, T* to, std::size_t count, Sum& sum) {
  file.read(reinterpret_cast<char*>(to), static_cast<std::streamsize>(count * sizeof(T)));
  sum.add(to, count * sizeof(T));
  return static_cast<bool>(file);
}

std::shared_ptr<const PatchTree> load(const fs::path& path, const Key& key,
                                      const std::shared_ptr<const TriangleMesh>& mesh) {
  std::ifstream file(path, std::ios::binary);
  Header header;
  Sum sum;
  if (!file || !read(file, &header, 1, sum)) return nullptr;
  Header wanted;
  wanted.mesh = key;
  wanted.triangles = mesh->triangles.size();
  // A tree over n triangles has less than 2 n nodes.
  if (header.nodes == 0 || header.nodes >= 2 * std::max<std::uint64_t>(1, wanted.triangles)) return nullptr;
  wanted.nodes = header.nodes;
  wanted.origin = header.origin;
  wanted.radius = header.radius;
  if (std::memcmp(&header, &wanted, sizeof header) != 0) return nullptr;
  std::vector<PatchNode> nodes(header.nodes);
  std::vector<std::uint32_t> order(header.triangles);
  if (!read(file, nodes.data(), nodes.size(), sum) || !read(file, order.data(), order.size(), sum)) return nullptr;
  Key stored;
  file.read(reinterpret_cast<char*>(&stored), sizeof stored);
  if (!file || stored != sum.key() || file.peek() != std::ifstream::traits_type::eof() || !is_sound(nodes, order))
    return nullptr;
  const Vec3 origin(header.origin[0], header.origin[1], header.origin[2]);
  return std::make_shared<const PatchTree>(mesh, std::move(nodes), std::move(order), origin, header.radius);
}

template <typename T>
void write(std::ofstream& file, const T* from, std::size_t count, Sum& sum) {
  file.write(reinterpret_cast<const char*>(from), static_cast<std::streamsize>(count * sizeof(T)));
  sum.add(from, count * sizeof(T));
}

/// Removes the oldest files as long as there are more than kMaxBytes.
void make_room() {
  std::error_code status;
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  std::uintmax_t bytes = 0;
  for (fs::directory_iterator i(folder(), status), end; !status && i != end; i.increment(status)) {
    if (i->path().extension() != ".patch") continue;
    bytes += i->file_size(status);
    files.emplace_back(i->last_write_time(status), i->path());
  }
  std::sort(files.begin(), files.end());
  for (std::size_t i = 0; i < files.size() && bytes > kMaxBytes; ++i) {
    bytes -= std::min(bytes, fs::file_size(files[i].second, status));
    fs::remove(files[i].second, status);
  }
}

void store(const fs::path& path, const Key& key, const PatchTree& tree) {
  std::error_code status;
  fs::create_directories(folder(), status);
  const fs::path partial = path.string() + "." + std::to_string(::getpid());
  {
    std::ofstream file(partial, std::ios::binary);
    Header header;
    header.mesh = key;
    header.triangles = tree.order().size();
    header.nodes = tree.nodes().size();
    header.origin = {tree.origin().x(), tree.origin().y(), tree.origin().z()};
    header.radius = tree.radius();
    Sum sum;
    write(file, &header, 1, sum);
    write(file, tree.nodes().data(), tree.nodes().size(), sum);
    write(file, tree.order().data(), tree.order().size(), sum);
    const Key end = sum.key();
    file.write(reinterpret_cast<const char*>(&end), sizeof end);
    file.close();
    if (!file) status = std::make_error_code(std::errc::io_error);
  }
  if (!status) fs::rename(partial, path, status);
  if (status)
    fs::remove(partial, status);
  else
    make_room();
}

std::shared_ptr<const PatchTree> stored_or_built(const std::shared_ptr<const TriangleMesh>& mesh) {
  if (folder().empty() || mesh->triangles.size() < kMinCached) return std::make_shared<const PatchTree>(mesh);
  const Key key = key_of(*mesh);
  const fs::path path = file_of(key);
  if (auto tree = load(path, key, mesh)) {
    std::error_code status;  // used now: others go before it when room is made
    fs::last_write_time(path, fs::file_time_type::clock::now(), status);
    return tree;
  }
  auto tree = std::make_shared<const PatchTree>(mesh);
  store(path, key, *tree);
  return tree;
}

}  // namespace

void set_hierarchy_cache(const std::string& path) {
  folder() = path;
}

std::string default_cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && cache[0] == '/') return std::string(cache) + "/tegotae";
  const char* home = std::getenv("HOME");
  return home != nullptr && home[0] == '/' ? std::string(home) + "/.cache/tegotae" : "";
}

std::shared_ptr<const PatchTree> cached_patch_tree(const std::shared_ptr<const TriangleMesh>& mesh) {
  // A tree keeps its mesh alive, so as long as there is one no other mesh has the same address.
  static std::mutex mutex;
  static std::map<const TriangleMesh*, std::weak_ptr<const PatchTree>> in_use;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    for (auto i = in_use.begin(); i != in_use.end();) i = i->second.expired() ? in_use.erase(i) : std::next(i);
    const auto known = in_use.find(mesh.get());
    if (known != in_use.end())
      if (auto tree = known->second.lock()) return tree;
  }
  auto tree = stored_or_built(mesh);
  const std::lock_guard<std::mutex> lock(mutex);
  in_use[mesh.get()] = tree;
  return tree;
}

}  // namespace tegotae
