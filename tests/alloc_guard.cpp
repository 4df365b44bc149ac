#include "alloc_guard.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdlib>

#include "core/sanitizers.hpp"

namespace {

// Plain thread-local integers: reading them allocates nothing, even in the first call of a new thread.
thread_local bool armed = false;
thread_local std::uint64_t counted = 0;

void note() noexcept {
  if (armed) ++counted;
}

}  // namespace

namespace tegotae::test {

AllocGuard::AllocGuard() noexcept {
  counted = 0;
  armed = true;
}
AllocGuard::~AllocGuard() noexcept {
  armed = false;
}
std::uint64_t AllocGuard::count() const noexcept {
  return counted;
}

}  // namespace tegotae::test

#ifdef TEGOTAE_SANITIZED

// A sanitizer has its own malloc, which offers hooks.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, std::size_t),
                                                         void (*on_free)(const volatile void*));
namespace {
const int installed = __sanitizer_install_malloc_and_free_hooks([](const volatile void*, std::size_t) { note(); },
                                                                [](const volatile void*) { note(); });
}  // namespace

#else

// glibc's own entry points, under the public names of which this executable defines counting ones. operator new of
// libstdc++ calls malloc.
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  note();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  note();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  note();
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  note();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  note();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  note();
  *memory = __libc_memalign(alignment, size);
  return *memory != nullptr ? 0 : ENOMEM;
}
void free(void* memory) {
  if (memory != nullptr) note();
  __libc_free(memory);
}
}

#endif
