#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <vector>

#include "core/sanitizers.hpp"
#include "import/mesh_pipe.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"

namespace tegotae {
namespace {

void limit(int resource, double value) {
  const auto which = static_cast<__rlimit_resource_t>(resource);
  rlimit bound{};
  // Whoever started the program may have set a lower one, which cannot be raised.
  if (getrlimit(which, &bound) != 0) std::_Exit(3);
  bound.rlim_cur = bound.rlim_max = std::min(bound.rlim_max, static_cast<rlim_t>(std::clamp(value, 0.0, 1e18)));
  if (setrlimit(which, &bound) != 0) std::_Exit(3);
}

/// Bounds of this process that nothing in it can take back.
void confine(double megabytes, double seconds) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody is left to read
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_FSIZE, 0);
  limit(RLIMIT_CPU, std::ceil(seconds));
#ifndef TEGOTAE_SANITIZED  // sanitizers reserve terabytes of address space
  limit(RLIMIT_AS, 1e6 * megabytes);
#else
  static_cast<void>(megabytes);
#endif
}

bool send(const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t n = write(kMeshPipe, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    size -= static_cast<std::size_t>(n);
  }
  return true;
}

int send_error(const std::string& text) {
  MeshPipeHead head;
  head.failed = 1;
  head.text_bytes = text.size();
  return send(&head, sizeof head) && send(text.data(), text.size()) ? 0 : 1;
}

int send_mesh(const TriangleMesh& mesh) {
  std::string notes;
  for (const std::string& note : mesh.notes) notes += note + '\n';
  MeshPipeHead head;
  head.text_bytes = mesh.name.size();
  head.note_bytes = notes.size();
  head.vertices = mesh.vertices.size();
  head.triangles = mesh.triangles.size();
  static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof mesh.triangles[0] == 3 * sizeof(std::uint32_t));
  const bool sent = send(&head, sizeof head) && send(mesh.name.data(), mesh.name.size()) &&
                    send(notes.data(), notes.size()) &&
                    send(mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3)) &&
                    send(mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
  return sent ? 0 : 1;
}

}  // namespace

int run_mesh_helper(char** argv) {
  try {
    confine(std::strtod(argv[2], nullptr), std::strtod(argv[3], nullptr));
    return send_mesh(load_mesh(argv[4], std::strtod(argv[1], nullptr)));
  } catch (const std::exception& e) {
    return send_error(e.what());
  }
}

}  // namespace tegotae
