#include "record/mcap_file.hpp"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <exception>
#include <new>

#include "record/recording_info.hpp"

namespace tegotae {

using namespace mcap;

namespace {

// What a killed process can lose; about a hundred times the schemas and channels that each chunk repeats.
constexpr std::size_t kChunkSize = 256 * 1024;
constexpr const char* kMetadataName = "tegotae";
constexpr const char* kCompression = "zstd";
constexpr int kCompressionLevel = 3;  // zstd's own default

std::uint32_t crc(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

std::string compressed(std::string_view bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kCompressionLevel);
  if (ZSTD_isError(size)) throw std::bad_alloc();  // the room is enough, so only memory can be what it lacks
  out.resize(size);
  return out;
}

std::uint16_t id(std::size_t topic) {
  return static_cast<std::uint16_t>(topic + 1);  // 0 stands for "no schema"
}

Bytes schemas_and_channels() {
  Bytes out;
  for (std::size_t i = 0; i < kFrameTopics; ++i) {
    const FrameTopic& t = kTopics[i];
    out.record(kSchema, Bytes().put(id(i)).put(t.schema_name).put("jsonschema").put(t.schema));
    out.record(kChannel, Bytes().put(id(i)).put(id(i)).put(t.topic).put("json").put(std::string_view()));
  }
  return out;
}

Bytes metadata(const RecordingInfo& info) {
  Bytes fields;
  for (const auto& [name, value] : info_fields(info)) fields.put(name).put(value);
  fields.put("units").put("m, rad, s, N, N*m");
  return Bytes().put(kMetadataName).put(fields.text);
}

}  // namespace

McapFile::McapFile(const std::string& path, const RecordingInfo& info) : file_(path), info_(info) {
  Bytes begin;
  begin.text = kMagic;
  begin.record(kHeader, Bytes().put(std::string_view()).put("tegotae"));
  file_.write(begin.text);
  write_metadata();
  file_.check();
}

void McapFile::write_metadata() {
  Bytes record;
  record.record(kMetadata, metadata(info_));
  metadata_.emplace_back(file_.size(), record.text.size());
  file_.write(record.text);
}

void McapFile::add(const RecordFrame& frame) noexcept {
  if (file_.failed()) return;
  try {
    add_messages(frame);
    if (records_.text.size() >= kChunkSize) write_chunk();
  } catch (const std::exception&) {  // only memory can run out here
    file_.fail_with(ENOMEM);
  }
}

void McapFile::add_messages(const RecordFrame& frame) {
  if (records_.text.empty()) records_ = schemas_and_channels();
  const std::uint64_t time = log_time(frame);
  for (std::size_t i = 0; i < kFrameTopics; ++i) {
    index_[i].emplace_back(time, records_.text.size());
    Bytes message;
    message.put(id(i)).put(static_cast<std::uint32_t>(frames_)).put(time).put(time);
    message.text += message_text(frame, i);
    records_.record(kMessage, message);
  }
  ++frames_;
}

void McapFile::write_chunk() {
  if (records_.text.empty()) return;
  const auto earlier = [](const TimeAndOffset& a, const TimeAndOffset& b) { return a.first < b.first; };
  const auto [first, last] = std::minmax_element(index_[0].begin(), index_[0].end(), earlier);
  Chunk chunk;
  chunk.begin = first->first;
  chunk.end = last->first;
  chunk.at = file_.size();
  chunk.size = records_.text.size();

  const std::string stored = compressed(records_.text);
  chunk.stored = stored.size();
  Bytes content;
  content.put(chunk.begin).put(chunk.end).put(chunk.size).put(crc(records_.text)).put(kCompression);
  content.put(chunk.stored).text += stored;
  Bytes out;
  out.record(kChunk, content);
  chunk.length = out.text.size();
  for (std::size_t i = 0; i < kFrameTopics; ++i) {
    chunk.index_at[i] = chunk.at + out.text.size();
    Bytes entries;
    for (const auto& [time, offset] : index_[i]) entries.put(time).put(offset);
    out.record(kMessageIndex, Bytes().put(id(i)).put(entries.text));
    index_[i].clear();
  }
  chunk.index_length = out.text.size() - chunk.length;
  file_.write(out.text);
  chunks_.push_back(chunk);
  records_.text.clear();
  if (!file_.failed()) written_ = frames_;
}

void McapFile::write_summary() {
  const std::uint64_t summary_at = file_.size();
  Bytes summary, offsets;
  // Groups of records of one kind, and where each group is.
  const auto group = [&](Opcode opcode, const Bytes& records) {
    if (records.text.empty()) return;
    offsets.record(kSummaryOffset, Bytes()
                                       .put(static_cast<std::uint8_t>(opcode))
                                       .put(summary_at + summary.text.size())
                                       .put(static_cast<std::uint64_t>(records.text.size())));
    summary.text += records.text;
  };

  Bytes schemas, channels, chunk_indexes, counts, statistics, metadata_index;
  std::uint64_t begin = chunks_.empty() ? 0 : chunks_.front().begin, end = 0;
  for (std::size_t i = 0; i < kFrameTopics; ++i) {
    const FrameTopic& t = kTopics[i];
    schemas.record(kSchema, Bytes().put(id(i)).put(t.schema_name).put("jsonschema").put(t.schema));
    channels.record(kChannel, Bytes().put(id(i)).put(id(i)).put(t.topic).put("json").put(std::string_view()));
    counts.put(id(i)).put(frames_);
  }
  for (const Chunk& c : chunks_) {
    Bytes where;
    for (std::size_t i = 0; i < kFrameTopics; ++i) where.put(id(i)).put(c.index_at[i]);
    Bytes content;
    content.put(c.begin).put(c.end).put(c.at).put(c.length).put(where.text).put(c.index_length);
    content.put(kCompression).put(c.stored).put(c.size);
    chunk_indexes.record(kChunkIndex, content);
    begin = std::min(begin, c.begin);
    end = std::max(end, c.end);
  }
  Bytes content;
  content.put(frames_ * kFrameTopics).put(static_cast<std::uint16_t>(kFrameTopics));
  content.put(static_cast<std::uint32_t>(kFrameTopics)).put(std::uint32_t{0});
  content.put(static_cast<std::uint32_t>(metadata_.size()));
  content.put(static_cast<std::uint32_t>(chunks_.size())).put(begin).put(end).put(counts.text);
  statistics.record(kStatistics, content);
  for (const auto& [at, length] : metadata_)
    metadata_index.record(kMetadataIndex, Bytes().put(at).put(length).put(kMetadataName));

  group(kSchema, schemas);
  group(kChannel, channels);
  group(kStatistics, statistics);
  group(kMetadataIndex, metadata_index);
  group(kChunkIndex, chunk_indexes);

  const std::uint64_t offsets_at = summary_at + summary.text.size();
  summary.text += offsets.text;
  // The checksum goes over the summary and the footer up to itself.
  summary.put(static_cast<std::uint8_t>(kFooter)).put(std::uint64_t{20}).put(summary_at).put(offsets_at);
  summary.put(crc(summary.text)).text += kMagic;
  file_.write(summary.text);
}

void McapFile::close(const std::string& continued_by) {
  if (!file_.failed()) {
    write_chunk();
    info_.continued_by = continued_by;
    if (!continued_by.empty()) write_metadata();                                // a reader takes the last one
    file_.write(Bytes().record(kDataEnd, Bytes().put(std::uint32_t{0})).text);  // 0: no checksum of all data
    write_summary();
  }
  file_.close();
}

}  // namespace tegotae
