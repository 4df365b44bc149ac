#pragma once

// Passes over vectors of numbers, compiled for several widths of a processor's registers and chosen at run time. The
// same operations in the same order, none fused: the results are the same on all of them.

// Not with ThreadSanitizer: the function that chooses the clone runs, instrumented, before its runtime is there.
#if defined(__x86_64__) && defined(__ELF__) && !defined(__SANITIZE_THREAD__)
#define TEGOTAE_WIDE __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define TEGOTAE_WIDE
#endif
#define TEGOTAE_INLINE __attribute__((always_inline)) inline
