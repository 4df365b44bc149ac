#include "record/mcap_reader.hpp"

#include <zlib.h>
#include <zstd.h>

#include <map>
#include <nlohmann/json.hpp>

#include "record/frame_messages.hpp"
#include "record/mcap_format.hpp"
#include "record/recording_info.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

using namespace mcap;

namespace {

// A frame is whole with these; its forces, if it has any, come before the last of them.
constexpr unsigned kNeededTopics = ((1u << kFrameTopics) - 1) & ~(1u << kForcesTopic);
// A chunk that says to be larger is damaged; common writers' are some megabytes.
constexpr std::uint64_t kMaxChunk = 1u << 30;

std::uint32_t checksum_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

class McapReader {
 public:
  McapReader(const std::string& path, const std::string& bytes) : path_(path), bytes_(bytes) {}

  Recording read() {
    Reader in(std::string_view(bytes_).substr(kMagic.size()));
    while (!in.empty()) {
      at_ = bytes_.size() - in.rest().size();
      const auto opcode = in.take<std::uint8_t>();
      const std::string_view content = in.take_bytes(in.take<std::uint64_t>());
      if (in.failed()) {
        out_.damage = "the file is cut at byte " + std::to_string(at_);
        break;
      }
      if (opcode == kDataEnd) return std::move(out_);
      if (!take_record(opcode, content)) break;
    }
    if (out_.damage.empty()) out_.damage = "the file has no end; it was not closed";
    return std::move(out_);
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    throw Error(ErrorKind::file, path_ + ": at byte " + std::to_string(at_) + ": " + reason, {path_, 0, {}, {}});
  }

  /// False when the record is damaged and reading ends.
  bool take_record(std::uint8_t opcode, std::string_view content) {
    switch (opcode) {
      case kMetadata:
        take_metadata(Reader(content));
        return true;
      case kChannel:
        take_channel(Reader(content));
        return true;
      case kMessage:
        take_message_record(Reader(content));
        return true;
      case kChunk:
        return take_chunk(Reader(content));
      default:
        return true;
    }
  }

  void take_metadata(Reader in) {
    if (in.take_string() != "tegotae") return;
    Reader entries(in.take_string());
    std::map<std::string, std::string> fields;
    while (!entries.empty()) {
      const std::string name(entries.take_string());
      fields[name] = std::string(entries.take_string());
    }
    if (in.failed() || entries.failed()) fail("metadata that end too early");
    out_.info = info_of(fields);
  }

  bool take_chunk(Reader in) {
    in.take<std::uint64_t>();
    in.take<std::uint64_t>();
    const auto size = in.take<std::uint64_t>();
    const auto checksum = in.take<std::uint32_t>();
    const std::string_view compression = in.take_string();
    std::string_view records = in.take_bytes(in.take<std::uint64_t>());
    std::string decompressed;
    bool whole = !in.failed() && size <= kMaxChunk;
    if (compression == "zstd" && whole) {
      decompressed.resize(size);
      const std::size_t got = ZSTD_decompress(decompressed.data(), size, records.data(), records.size());
      whole = !ZSTD_isError(got);
      records = decompressed;
      if (whole) records = records.substr(0, got);
    } else if (!compression.empty() && compression != "zstd") {
      fail("compression \"" + std::string(compression) + "\" is not supported (zstd and none are)");
    }
    whole = whole && records.size() == size && (checksum == 0 || checksum == checksum_of(records));
    if (!whole) {
      out_.damage = "the chunk at byte " + std::to_string(at_) + " is damaged";
      return false;
    }
    Reader inside(records);
    while (!inside.empty()) {
      const auto opcode = inside.take<std::uint8_t>();
      const std::string_view content = inside.take_bytes(inside.take<std::uint64_t>());
      if (inside.failed() || opcode == kChunk) fail("a chunk with wrong records");
      take_record(opcode, content);
    }
    return true;
  }

  void take_channel(Reader in) {
    const auto id = in.take<std::uint16_t>();
    in.take<std::uint16_t>();
    const std::string_view topic = in.take_string();
    if (in.take_string() != "json") return;  // another program's channel
    for (std::size_t i = 0; i < kFrameTopics; ++i)
      if (topic == kTopics[i].topic) topics_[id] = i;
  }

  void take_message_record(Reader in) {
    const auto channel = topics_.find(in.take<std::uint16_t>());
    in.take<std::uint32_t>();
    in.take<std::uint64_t>();
    in.take<std::uint64_t>();
    if (in.failed()) fail("a message that ends too early");
    if (channel == topics_.end()) return;
    // A frame's messages follow each other; a topic that comes again begins the next frame.
    const unsigned bit = 1u << channel->second;
    if ((seen_ & bit) != 0) fail("a frame without all of its messages");
    try {
      take_message(nlohmann::json::parse(in.rest()), channel->second, frame_);
    } catch (const nlohmann::json::exception& e) {
      fail(std::string("a message on ") + kTopics[channel->second].topic + ": " + e.what());
    }
    seen_ |= bit;
    if ((seen_ & kNeededTopics) != kNeededTopics) return;
    out_.frames.push_back(frame_);
    frame_ = {};
    seen_ = 0;
  }

  const std::string& path_;
  const std::string& bytes_;
  std::size_t at_ = 0;
  std::map<std::uint16_t, std::size_t> topics_;  // by channel
  RecordFrame frame_;
  unsigned seen_ = 0;  // messages of frame_ so far, a bit a topic
  Recording out_;
};

}  // namespace

Recording read_mcap(const std::string& path, const std::string& bytes) {
  return McapReader(path, bytes).read();
}

}  // namespace tegotae
