#pragma once

#include <vector>

#include "tegotae/contact/contact.hpp"

namespace tegotae {

/// Which of too many pairs are followed on. Deterministic; never allocates after it was made.
class ContactChoice {
 public:
  /// For up to `capacity` pairs.
  explicit ContactChoice(std::size_t capacity);

  /// Chooses at most `most` pairs. `constraints` with `owners` (of each constraint its pair, below `pairs`) are what
  /// the pairs ask for; `must(pair)` says which are kept whatever happens. What is left goes to pairs that hold the
  /// part against a motion of their own (of many sampled ones the pair that it closes most), and then to the nearest.
  /// Sets kept().
  void choose(const std::vector<Contact>& constraints, const std::vector<std::uint32_t>& owners, std::size_t pairs,
              std::size_t most, const std::vector<std::uint8_t>& must);
  const std::vector<std::uint8_t>& kept() const { return kept_; }

 private:
  void keep(std::uint32_t pair);
  void keep_supports(const std::vector<Contact>& constraints, const std::vector<std::uint32_t>& owners,
                     std::size_t most);

  struct Near {
    double gap;
    std::uint32_t pair;
    bool operator<(const Near& o) const { return gap != o.gap ? gap < o.gap : pair < o.pair; }
  };

  std::vector<Vec6> directions_;
  std::vector<double> best_;             ///< of each direction: how fast it closes the pair below
  std::vector<std::uint32_t> supports_;  ///< of each direction
  std::vector<std::uint8_t> kept_;
  std::vector<Near> near_;
  std::size_t count_ = 0;
};

}  // namespace tegotae
