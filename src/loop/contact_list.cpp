#include "loop/contact_list.hpp"

#include <algorithm>
#include <tuple>

namespace tegotae {
namespace {

/// Of a ContactPoint, a Contact or a ContactForce.
template <typename C>
auto identity(const C& c) {
  return std::make_tuple(c.part.index, c.feature_a.kind, c.feature_a.index, c.feature_b.kind, c.feature_b.index);
}

template <typename A, typename B>
bool same(const A& a, const B& b) {
  return identity(a) == identity(b);
}

template <typename A, typename B>
bool less(const A& a, const B& b) {
  return identity(a) < identity(b);
}

ContactPoint contact_point(const Contact& c, const Vec3& center_W) {
  ContactPoint p{c.part, c.feature_a, c.feature_b, center_W + c.r, Vec3::Zero(), c.n, c.gap, {}, Vec3::Zero(), false,
                 0};
  p.point_b = p.point_a - c.gap * c.n;
  return p;
}

}  // namespace

ContactList::ContactList() {
  contacts_.reserve(kMaxContacts);
  listed_.reserve(kMaxContacts);
  before_.reserve(kMaxContacts);
  events_.reserve(2 * kMaxContacts);
}

void ContactList::clear() noexcept {
  contacts_.clear();
  events_.clear();
}

void ContactList::update(const std::vector<Contact>& constraints, const TickReport& report,
                         const Vec3& center_W) noexcept {
  std::swap(contacts_, before_);
  gather(constraints, report, center_W);
  compare();
}

void ContactList::list(const std::vector<Contact>& constraints, std::uint32_t which) noexcept {
  // A heap, the farthest first, from when it is full.
  const auto nearer = [&constraints](std::uint32_t a, std::uint32_t b) {
    return constraints[a].gap < constraints[b].gap;
  };
  if (listed_.size() == kMaxContacts) {
    if (!nearer(which, listed_.front())) return;
    std::pop_heap(listed_.begin(), listed_.end(), nearer);
    listed_.back() = which;
    std::push_heap(listed_.begin(), listed_.end(), nearer);
    return;
  }
  listed_.push_back(which);
  if (listed_.size() == kMaxContacts) std::make_heap(listed_.begin(), listed_.end(), nearer);
}

void ContactList::gather(const std::vector<Contact>& constraints, const TickReport& report,
                         const Vec3& center_W) noexcept {
  const ContactForces& forces = report.forces;
  const ContactForce* const end = forces.items.data() + forces.count;
  const auto carries = [&forces, end](const Contact& c) {
    return std::any_of(forces.items.data(), end, [&c](const ContactForce& f) { return same(f, c); });
  };
  listed_.clear();
  for (std::uint32_t i = 0; i < constraints.size(); ++i) {
    const Contact& c = constraints[i];
    if (c.age != kOneShotAge && (c.gap <= report.contact_gap || carries(c))) list(constraints, i);
  }
  // By identity, and the nearest first among those of one. Contacts are large, so that their numbers are sorted.
  std::sort(listed_.begin(), listed_.end(), [&constraints](std::uint32_t i, std::uint32_t k) {
    const Contact &a = constraints[i], &b = constraints[k];
    return same(a, b) ? a.gap < b.gap : less(a, b);
  });
  contacts_.clear();
  for (const std::uint32_t i : listed_) {
    if (!contacts_.empty() && same(contacts_.back(), constraints[i])) continue;
    contacts_.push_back(contact_point(constraints[i], center_W));
    if (forces.available) contacts_.back().force = 0;
  }
  for (const ContactForce* f = forces.items.data(); f != end; ++f) {
    const auto at = std::lower_bound(contacts_.begin(), contacts_.end(), *f, less<ContactPoint, ContactForce>);
    if (at == contacts_.end() || !same(*at, *f)) continue;
    at->force = at->force.value_or(0) + f->force;
    at->friction += f->friction;
    at->slides |= f->slides;
  }
}

void ContactList::compare() noexcept {
  events_.clear();
  auto old = before_.cbegin();
  const auto end_old_before = [this, &old](const ContactPoint* next) {
    for (; old != before_.cend() && (next == nullptr || less(*old, *next)); ++old)
      events_.push_back({ContactEvent::Kind::ended, *old});
  };
  for (ContactPoint& now : contacts_) {
    end_old_before(&now);
    if (old != before_.cend() && same(*old, now)) {
      now.ticks = old->ticks + 1;
      ++old;
    } else {
      events_.push_back({ContactEvent::Kind::began, now});
    }
  }
  end_old_before(nullptr);
}

}  // namespace tegotae
