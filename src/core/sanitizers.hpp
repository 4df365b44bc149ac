#pragma once

// TEGOTAE_SANITIZED: AddressSanitizer or ThreadSanitizer is compiled in, which GCC and clang say in different ways.
// They need address space without bound, have a heap of their own, and make every memory access slow.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TEGOTAE_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define TEGOTAE_SANITIZED 1
#endif
#endif
