#pragma once

/// Marks what the shared library shows. Every public header says `namespace tegotae TEGOTAE_EXPORT {`: that shows what
/// is declared in this one block; everything else is compiled with hidden visibility.
#define TEGOTAE_EXPORT __attribute__((visibility("default")))
