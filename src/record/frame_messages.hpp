#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tegotae/record/recording.hpp"

namespace tegotae {

/// A topic of an MCAP recording. Every frame is one message on each of them, with the same sequence number.
struct FrameTopic {
  const char* topic;
  const char* schema_name;
  const char* schema;  ///< JSON schema
};

inline constexpr std::size_t kFrameTopics = 6;
/// The topic that recordings of older versions do not have. It comes before the last one, which ends a frame.
inline constexpr std::size_t kForcesTopic = 4;
extern const std::array<FrameTopic, kFrameTopics> kTopics;

/// The message of `frame` on topic number `i`, as JSON text. Numbers that are not finite are null.
std::string message_text(const RecordFrame& frame, std::size_t i);

/// The other way round: puts the message of topic number `i` into `frame`. Throws nlohmann's exceptions when something
/// is missing or of another type.
void take_message(const nlohmann::json& message, std::size_t i, RecordFrame& frame);

/// Time of a frame in an MCAP file, ns from the start of the run.
std::uint64_t log_time(const RecordFrame& frame);

}  // namespace tegotae
