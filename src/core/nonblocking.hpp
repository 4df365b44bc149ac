#pragma once

// Marks what a real-time thread calls: it never allocates, locks, waits, prints or throws. Where the compiler knows the
// attribute, a build with -fsanitize=realtime (tests/checks.sh rtsan) ends the program at the first call that may
// block.
#if defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
#define TEGOTAE_NONBLOCKING [[clang::nonblocking]]
#endif
#endif
#ifndef TEGOTAE_NONBLOCKING
#define TEGOTAE_NONBLOCKING
#endif
