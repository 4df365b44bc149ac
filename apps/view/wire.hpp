#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "view/frame.hpp"

namespace tegotae::view {

// A frame on its way to a page is a row of 32-bit floats: kFrameFloats of them, then kPairFloats for each pair and
// kForceFloats for each contact force. The page reads them in apps/web/src/view/frame.js.
inline constexpr std::size_t kFrameFloats = 34;
inline constexpr std::size_t kPairFloats = 8;
inline constexpr std::size_t kForceFloats = 11;

/// Appends the frame without its pairs and forces.
void append_frame(const Frame& frame, std::vector<float>& out);
/// Appends the frame's pairs.
void append_pairs(const Frame& frame, std::vector<float>& out);
/// Appends the frame's contact forces.
void append_forces(const Frame& frame, std::vector<float>& out);

// What goes through the stream: 32 bits of kind, 32 bits of length in bytes, and that many bytes.
enum class Message : std::uint32_t { frame = 1, status = 2 };

std::string frame_message(const Frame& frame);
std::string status_message(std::string_view json);

/// What a page sends: a JSON object of a few numbers in two levels, for ViewSource::command. Throws Error when it is
/// deeper, json::exception when it is not JSON.
nlohmann::json parse_command(std::string_view text);

}  // namespace tegotae::view
