#include "import/gltf_data.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "import/file_check.hpp"
#include "import/load_files.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

// Of views. Without an URI only the first buffer of a GLB file has data.
constexpr const char* kNoData = " lies in a buffer that has no data";

/// cgltf's way to read a buffer's file: at least `*size` bytes, from regular files in the glTF file's folder and below.
cgltf_result read_buffer(const cgltf_memory_options*, const cgltf_file_options* options, const char* file,
                         cgltf_size* size, void** data) {
  if (!MeshFolder(*static_cast<const std::string*>(options->user_data)).Exists(file))
    return cgltf_result_file_not_found;
  const std::string bytes = read_bytes(file);
  if (bytes.size() < *size) return cgltf_result_data_too_short;
  *data = std::malloc(*size > 0 ? *size : 1);
  if (*data == nullptr) return cgltf_result_out_of_memory;
  std::memcpy(*data, bytes.data(), *size);
  return cgltf_result_success;
}

void free_buffer(const cgltf_memory_options*, const cgltf_file_options*, void* data) {
  std::free(data);
}

void require(const std::string& path, cgltf_result result) {
  if (result == cgltf_result_success) return;
  if (result == cgltf_result_out_of_memory) throw std::bad_alloc();
  if (result == cgltf_result_file_not_found)
    throw Error(path + ": a buffer is missing, or is not a regular file in the folder of the glTF file");
  throw Error(path + ": truncated or damaged: cgltf: error " + std::to_string(static_cast<int>(result)));
}

/// 0 when `from` was whole.
int decode(const cgltf_meshopt_compression& from, const unsigned char* bytes, void* to) {
  switch (from.mode) {
    case cgltf_meshopt_compression_mode_attributes:
      return meshopt_decodeVertexBuffer(to, from.count, from.stride, bytes, from.size);
    case cgltf_meshopt_compression_mode_triangles:
      return meshopt_decodeIndexBuffer(to, from.count, from.stride, bytes, from.size);
    case cgltf_meshopt_compression_mode_indices:
      return meshopt_decodeIndexSequence(to, from.count, from.stride, bytes, from.size);
    default:
      return -1;
  }
}

void undo_filter(const cgltf_meshopt_compression& from, void* to) {
  if (from.filter == cgltf_meshopt_compression_filter_octahedral) meshopt_decodeFilterOct(to, from.count, from.stride);
  if (from.filter == cgltf_meshopt_compression_filter_quaternion) meshopt_decodeFilterQuat(to, from.count, from.stride);
  if (from.filter == cgltf_meshopt_compression_filter_exponential) meshopt_decodeFilterExp(to, from.count, from.stride);
}

/// EXT_meshopt_compression: the view's data becomes what its bytes decode to. Sizes were checked by check_gltf.
void decompress(const std::string& path, std::size_t i, cgltf_buffer_view& view) {
  const cgltf_meshopt_compression& from = view.meshopt_compression;
  const auto* buffer = static_cast<const unsigned char*>(from.buffer->data);
  view.data = std::malloc(from.count * from.stride);  // cgltf frees it
  if (view.data == nullptr) throw std::bad_alloc();
  if (buffer == nullptr) throw Error(path + ": damaged: bufferView " + std::to_string(i) + kNoData);
  if (decode(from, buffer + from.offset, view.data) != 0)
    throw Error(path + ": damaged: bufferView " + std::to_string(i) + " is not a stream of EXT_meshopt_compression");
  undo_filter(from, view.data);
}

}  // namespace

GltfData parse_gltf(const std::string& path, const CheckedGltf& checked) {
  cgltf_options options{};
  options.type = cgltf_file_type_gltf;
  options.file.read = read_buffer;
  options.file.release = free_buffer;
  options.file.user_data = const_cast<std::string*>(&path);
  cgltf_data* raw = nullptr;
  const cgltf_result parsed = cgltf_parse(&options, checked.json.data(), checked.json.size(), &raw);
  GltfData data(raw);
  require(path, parsed);
  data->bin = checked.chunk.data();
  data->bin_size = checked.chunk.size();
  require(path, cgltf_load_buffers(&options, data.get(), path.c_str()));
  for (std::size_t i = 0; i < data->buffer_views_count; ++i)
    if (data->buffer_views[i].has_meshopt_compression) decompress(path, i, data->buffer_views[i]);
  return data;
}

namespace {

/// cgltf reads zeros where there is nothing.
void require_data(const std::string& path, const cgltf_accessor& accessor) {
  if (accessor.buffer_view != nullptr && cgltf_buffer_view_data(accessor.buffer_view) == nullptr)
    throw Error(path + ": damaged: an accessor" + kNoData);
}

/// cgltf takes indices of any kind of number, also of floats.
void require_indices(const std::string& path, const cgltf_accessor& accessor) {
  require_data(path, accessor);
  if (accessor.component_type != cgltf_component_type_r_8u && accessor.component_type != cgltf_component_type_r_16u &&
      accessor.component_type != cgltf_component_type_r_32u)
    throw Error(path + ": damaged: indices are not unsigned whole numbers");
}

void unpack(const std::string& path, const cgltf_accessor& accessor, std::vector<float>& numbers) {
  require_data(path, accessor);
  numbers.resize(cgltf_num_components(accessor.type) * accessor.count);
  if (cgltf_accessor_unpack_floats(&accessor, numbers.data(), numbers.size()) != numbers.size())
    throw Error(path + ": damaged: the numbers of an accessor cannot be read");
  // Signed integers have one value below -1, which stands for -1 too; cgltf takes it for what it is.
  if (accessor.normalized &&
      (accessor.component_type == cgltf_component_type_r_8 || accessor.component_type == cgltf_component_type_r_16))
    for (float& number : numbers) number = std::max(number, -1.0f);
}

/// The two parts of a sparse accessor: which elements change, and to what.
struct Changes {
  cgltf_accessor indices{}, values{};
};

Changes changes_of(const cgltf_accessor& accessor) {
  const cgltf_accessor_sparse& sparse = accessor.sparse;
  Changes out;
  out.values = accessor;
  out.indices.component_type = sparse.indices_component_type;
  out.indices.type = cgltf_type_scalar;
  out.indices.stride = cgltf_component_size(sparse.indices_component_type);
  out.indices.offset = sparse.indices_byte_offset;
  out.indices.buffer_view = sparse.indices_buffer_view;
  out.indices.count = sparse.count;
  out.values.is_sparse = 0;
  out.values.stride = cgltf_calc_size(accessor.type, accessor.component_type);
  out.values.offset = sparse.values_byte_offset;
  out.values.buffer_view = sparse.values_buffer_view;
  out.values.count = sparse.count;
  return out;
}

/// Calls `each` with the number of an element that a sparse accessor changes and its number among the changes.
template <class Each>
void for_changes(const std::string& path, const cgltf_accessor& accessor, const Changes& changes, Each each) {
  require_indices(path, changes.indices);
  for (std::size_t i = 0; i < changes.indices.count; ++i) {
    const std::size_t to = cgltf_accessor_read_index(&changes.indices, i);
    if (to >= accessor.count)
      throw Error(path + ": index out of range: a sparse accessor changes an element that it does not have");
    each(to, i);
  }
}

/// Puts the elements that a sparse accessor changes into `numbers`.
void change(const std::string& path, const cgltf_accessor& accessor, std::vector<float>& numbers) {
  const Changes changes = changes_of(accessor);
  std::vector<float> changed;
  unpack(path, changes.values, changed);
  const std::size_t components = cgltf_num_components(accessor.type);
  for_changes(path, accessor, changes, [&](std::size_t to, std::size_t i) {
    std::copy_n(&changed[i * components], components, &numbers[to * components]);
  });
}

}  // namespace

std::vector<double> numbers_of(const std::string& path, const cgltf_accessor& accessor, std::size_t components) {
  if (cgltf_num_components(accessor.type) != components)
    throw Error(path + ": damaged: an accessor does not have the type that its use requires");
  cgltf_accessor dense = accessor;
  dense.is_sparse = 0;
  std::vector<float> numbers;
  unpack(path, dense, numbers);
  if (accessor.is_sparse) change(path, accessor, numbers);
  return {numbers.begin(), numbers.end()};
}

std::vector<Vec3> points_of(const std::string& path, const cgltf_accessor& accessor) {
  const std::vector<double> numbers = numbers_of(path, accessor, 3);
  std::vector<Vec3> points(numbers.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = Vec3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
  return points;
}

std::vector<std::size_t> indices_of(const std::string& path, const cgltf_accessor& accessor) {
  if (accessor.type != cgltf_type_scalar) throw Error(path + ": damaged: indices of a primitive are not scalars");
  require_indices(path, accessor);
  cgltf_accessor dense = accessor;
  dense.is_sparse = 0;
  std::vector<std::size_t> indices(accessor.count, 0);
  if (dense.buffer_view != nullptr)
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = cgltf_accessor_read_index(&dense, i);
  if (!accessor.is_sparse) return indices;
  const Changes changes = changes_of(accessor);
  require_data(path, changes.values);
  for_changes(path, accessor, changes,
              [&](std::size_t to, std::size_t i) { indices[to] = cgltf_accessor_read_index(&changes.values, i); });
  return indices;
}

}  // namespace tegotae
