#pragma once

/// The library's version (semantic versioning, see docs/package.md). CMake, the package and the programs read it from
/// here.
#define TEGOTAE_VERSION_MAJOR 0
#define TEGOTAE_VERSION_MINOR 1
#define TEGOTAE_VERSION_PATCH 0
/// One number to compare: `#if TEGOTAE_VERSION >= 10200` tests for 1.2.0 or newer.
#define TEGOTAE_VERSION (10000 * TEGOTAE_VERSION_MAJOR + 100 * TEGOTAE_VERSION_MINOR + TEGOTAE_VERSION_PATCH)
/// The version as text.
#define TEGOTAE_VERSION_STRING "0.1.0"
