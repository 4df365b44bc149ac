#include "narrowphase/sweep_task.hpp"

#include <algorithm>

namespace tegotae {
namespace {

constexpr std::uint64_t kNoFaces = ~std::uint64_t{0};

}  // namespace

void SweepTask::open(const Question& question, const SharedLimit::Value& end_until_now,
                     const SharedLimit::Value& faces_end_until_now, std::uint32_t searched_until_now) noexcept {
  question_ = question;
  ++id_;
  end.set(end_until_now);
  faces_end.set(faces_end_until_now);
  searched.store(searched_until_now);
  for (std::uint32_t piece = 0; piece < question.pieces; ++piece) done_[piece].store(0, std::memory_order_relaxed);
  for (auto& faces : met_faces_) faces.store(kNoFaces, std::memory_order_relaxed);
  next_.store(0);
  met_.store(0);
  ending_.store(Ending::none);
  closed_.store(false);
}

std::optional<std::uint32_t> SweepTask::take() noexcept {
  if (next_.load() < question_.pieces)
    if (const std::uint32_t piece = next_.fetch_add(1); piece < question_.pieces) return piece;
  for (std::uint32_t piece = 0; piece < question_.pieces; ++piece)
    if (!is_done(piece)) return piece;
  return std::nullopt;
}

void SweepTask::add_met(const Met& met) noexcept {
  // A thread that was late may still write here while the owner reads: of what it did, others have done the same.
  const std::size_t at = met_.fetch_add(1) % kMostMet;
  met_share_[at].store(met.share);
  met_faces_[at].store(std::uint64_t{met.a} << 32 | met.b);
}

std::size_t SweepTask::met(std::array<Met, kMostMet>& out) const noexcept {
  std::size_t count = 0;
  for (std::size_t i = 0; i < kMostMet; ++i) {
    const std::uint64_t faces = met_faces_[i].load();
    if (faces == kNoFaces) continue;
    const Met one{met_share_[i].load(), static_cast<std::uint32_t>(faces >> 32), static_cast<std::uint32_t>(faces)};
    const auto last = out.begin() + static_cast<std::ptrdiff_t>(count);
    const auto same = [&](const Met& other) { return other.a == one.a && other.b == one.b; };
    if (std::any_of(out.begin(), last, same)) continue;
    const auto at =
        std::upper_bound(out.begin(), last, one.share, [](double s, const Met& other) { return s < other.share; });
    std::move_backward(at, last, last + 1);
    *at = one;
    ++count;
  }
  return count;
}

}  // namespace tegotae
