#pragma once

#include <array>
#include <utility>
#include <vector>

#include "core/output_file.hpp"
#include "record/frame_messages.hpp"
#include "record/mcap_format.hpp"
#include "record/record_file.hpp"

namespace tegotae {

/// An MCAP recording: chunks of JSON messages, each chunk with its schemas and channels, and a summary with indexes.
class McapFile final : public RecordFile {
 public:
  McapFile(const std::string& path, const RecordingInfo& info);

  void add(const RecordFrame& frame) noexcept override;
  void flush() noexcept override {}  // a chunk leaves when it is full
  void hurry() noexcept override { file_.hurry(); }
  std::uint64_t written() const noexcept override { return written_; }
  void close(const std::string& continued_by) override;

 private:
  using TimeAndOffset = std::pair<std::uint64_t, std::uint64_t>;
  struct Chunk {
    std::uint64_t begin = 0, end = 0;  // log times
    std::uint64_t at = 0, length = 0;  // of the record in the file
    std::array<std::uint64_t, kFrameTopics> index_at{};
    std::uint64_t index_length = 0;
    std::uint64_t size = 0, stored = 0;  // of the records in it, as they are and as stored
  };

  void write_metadata();
  void add_messages(const RecordFrame& frame);
  void write_chunk();
  void write_summary();

  OutputFile file_;
  RecordingInfo info_;
  mcap::Bytes records_;  // of the chunk that is being filled
  std::array<std::vector<TimeAndOffset>, kFrameTopics> index_;
  std::vector<Chunk> chunks_;
  std::uint64_t frames_ = 0, written_ = 0;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> metadata_;  // where each such record is, and how long
};

}  // namespace tegotae
