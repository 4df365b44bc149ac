#include "mesh/content_sum.hpp"

#define XXH_INLINE_ALL  // nothing to link, here or by who uses the installed library
#include <xxhash.h>

namespace tegotae {

struct ContentSum::State {
  XXH3_state_t xxh;
};

ContentSum::ContentSum() : state_(std::make_unique<State>()) {
  XXH3_128bits_reset(&state_->xxh);
}

ContentSum::~ContentSum() = default;

void ContentSum::add(const void* data, std::size_t bytes) noexcept {
  XXH3_128bits_update(&state_->xxh, data, bytes);
}

ContentKey ContentSum::key() const noexcept {
  const XXH128_hash_t h = XXH3_128bits_digest(&state_->xxh);
  return {h.low64, h.high64};
}

}  // namespace tegotae
