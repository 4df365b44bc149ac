// The MCAP container (mcap.dev, specification of version 0): records of a one-byte opcode, an eight-byte length and the
// content, all little-endian; strings, byte arrays, maps and arrays carry their length in bytes (four bytes).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>

namespace tegotae::mcap {

inline constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);

enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kMetadata = 0x0C,
  kMetadataIndex = 0x0D,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// Builds a record's content, or a run of records.
class Bytes {
 public:
  template <class Integer, class = std::enable_if_t<std::is_integral_v<Integer>>>
  Bytes& put(Integer value) {
    for (std::size_t i = 0; i < sizeof value; ++i)
      text.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i)));
    return *this;
  }
  /// A string, array or map: its length in bytes, then itself.
  Bytes& put(std::string_view bytes) {
    put(static_cast<std::uint32_t>(bytes.size()));
    text += bytes;
    return *this;
  }
  Bytes& record(Opcode opcode, const Bytes& content) {
    put(static_cast<std::uint8_t>(opcode)).put(static_cast<std::uint64_t>(content.text.size()));
    text += content.text;
    return *this;
  }

  std::string text;
};

/// Reads them back; every read past the end fails, and so do all after it.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}

  template <class Integer>
  Integer take() {
    const std::string_view bytes = take_bytes(sizeof(Integer));
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i)
      value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[i])) << (8 * i);
    return static_cast<Integer>(value);
  }
  std::string_view take_string() { return take_bytes(take<std::uint32_t>()); }
  std::string_view take_bytes(std::uint64_t count) {
    if (count > rest_.size()) {
      failed_ = true;
      rest_ = {};
      return {};
    }
    const std::string_view bytes = rest_.substr(0, static_cast<std::size_t>(count));
    rest_.remove_prefix(bytes.size());
    return bytes;
  }
  std::string_view rest() const { return rest_; }
  bool empty() const { return rest_.empty(); }
  bool failed() const { return failed_; }

 private:
  std::string_view rest_;
  bool failed_ = false;
};

}  // namespace tegotae::mcap
