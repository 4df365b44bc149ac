#include "review/start_findings.hpp"

#include <algorithm>
#include <optional>

#include "loop/containment_test.hpp"
#include "loop/initial_contacts.hpp"
#include "loop/inward_offset.hpp"
#include "loop/scene_parts.hpp"
#include "session/pose_check.hpp"

namespace tegotae::review {
namespace {

// Farther than this (m) the run's certificate, which asks for kGapFloor, surely finds two parts apart.
constexpr double kApart = kGapFloor + 2e-7;

class Starter {
 public:
  Starter(const Scene& scene, const std::vector<RecordFrame>& rows, const Scan& scan)
      : scene_(scene), rows_(rows), scan_(scan), start_(scan.start) {
    for (const InitialContact& pair : start_.pairs) waiting_ += pair.state == InitialContactState::active ? 0 : 1;
  }

  StartFindings all() {
    StartFindings out;
    out.shift = start_.shift;
    for (const InitialContact& pair : start_.pairs) {
      row_of_.push_back(pair.state == InitialContactState::active ? 0 : free_row(pair));
      if (pair.state != InitialContactState::active) free_from_.push_back(row_of_.back());
    }
    std::sort(free_from_.begin(), free_from_.end());
    for (std::size_t i = 0; i < start_.pairs.size(); ++i) out.pairs.push_back(finding(i));
    out.intersecting = intersecting();
    return out;
  }

 private:
  const RecordFrame& row(std::size_t i) const { return rows_[scan_.rows[i].row]; }

  bool apart(std::size_t i, const InitialContact& pair, const std::optional<ContainmentTest>& inside) const {
    for (const Clearance& c : scan_.rows[i].clearances)
      if (c.part == pair.part && c.distance <= kApart) return false;
    return !inside || !inside->inside(scene_.parts[pair.part].pose.inverse() * row(i).x);
  }

  /// From which row on the pair had come free; the number of rows when it never had. The run asks about one of the
  /// waiting pairs a tick, so parts that were apart for as many ticks as there are such pairs have been asked about.
  std::size_t free_row(const InitialContact& pair) const {
    std::optional<ContainmentTest> inside;
    if (pair.state == InitialContactState::filtered)
      inside.emplace(held_part(scene_).mesh, scene_.parts[pair.part].mesh);
    std::uint64_t since = 0;  // tick from which on they are apart
    bool are_apart = false;
    for (std::size_t i = 0; i < scan_.rows.size(); ++i) {
      const bool were_apart = are_apart;
      are_apart = apart(i, pair, inside);
      if (!were_apart) since = row(i).tick;
      if (are_apart && row(i).tick >= since + waiting_) return scan_.rows[i].row;
    }
    return rows_.size();
  }

  StartFinding finding(std::size_t i) const {
    StartFinding f;
    f.pair = start_.pairs[i];
    if (f.pair.state == InitialContactState::active) return f;
    f.deeper = deeper(f.pair, row_of_[i]);
    if (row_of_[i] < rows_.size()) f.until = rows_[row_of_[i]].t;
    return f;
  }

  /// How many pairs had come free at a row.
  std::uint32_t freed(std::size_t row) const {
    return static_cast<std::uint32_t>(std::upper_bound(free_from_.begin(), free_from_.end(), row) - free_from_.begin());
  }

  std::int64_t intersecting() const {
    InitialContactReport start = start_;
    for (std::size_t i = 0; i < start.pairs.size(); ++i)
      if (start.pairs[i].state != InitialContactState::active)
        start.pairs[i].freed = row_of_[i] < rows_.size() ? freed(row_of_[i]) : InitialContact::kNotYet;
    PoseCheck check;
    for (std::size_t r = 0; r < rows_.size(); ++r) check.add(rows_[r].x, freed(r));
    return check.count_intersecting(scene_, start);
  }

  std::int64_t deeper(const InitialContact& pair, std::size_t end) const {
    Scene two;
    two.parts = {held_part(scene_), scene_.parts[pair.part]};
    if (pair.state == InitialContactState::shrunk) {
      std::shared_ptr<const TriangleMesh>& mesh = two.parts[1].mesh;
      mesh = std::make_shared<TriangleMesh>(inward_offset(Surface(mesh), pair.inward_offset));
    }
    PoseCheck check;
    for (std::size_t r = 0; r < end; ++r) check.add(rows_[r].x);
    return check.count_intersecting(two);
  }

  const Scene& scene_;
  const std::vector<RecordFrame>& rows_;
  const Scan& scan_;
  const InitialContactReport& start_;
  std::uint64_t waiting_ = 0;           // pairs that were not free at the start
  std::vector<std::size_t> row_of_;     // of each pair: from which row on it was free
  std::vector<std::size_t> free_from_;  // these rows, of pairs that were not, in order
};

}  // namespace

StartFindings find_start(const Scene& scene, const std::vector<RecordFrame>& rows, const Scan& scan) {
  return Starter(scene, rows, scan).all();
}

}  // namespace tegotae::review
