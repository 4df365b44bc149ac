#pragma once

#include <cstddef>

#include "tegotae/record/recorder.hpp"

namespace tegotae {

/// The header row, with its end of line.
extern const char* const kRecordHeader;

/// No row is longer: four integers of at most 20 characters, 24 numbers of at most 24, commas and the end of line.
inline constexpr std::size_t kMaxRecordRow = 1024;

/// Writes `frame` as a row with its end of line into `row` (kMaxRecordRow characters) and returns its length. Numbers
/// are the shortest that read back as the same bits, in the C locale.
std::size_t format_row(const RecordFrame& frame, char* row) noexcept;

}  // namespace tegotae
