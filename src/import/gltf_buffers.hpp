#pragma once

#include <string>
#include <vector>

namespace tegotae {

/// `uri` of a glTF file without its percent signs.
std::string decoded_uri(const std::string& uri);

/// The files beside a glTF or GLB file that hold its buffers. The file has been read: one that is none has none.
std::vector<std::string> gltf_buffer_files(const std::string& path);

}  // namespace tegotae
