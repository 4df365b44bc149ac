#include "loop/contact_list.hpp"

#include <algorithm>
#include <tuple>

namespace tegotae {
namespace {

auto identity(const ContactPoint& c) {
  return std::make_tuple(c.part.index, c.feature_a.kind, c.feature_a.index, c.feature_b.kind, c.feature_b.index);
}

bool same(const ContactPoint& a, const ContactPoint& b) {
  return identity(a) == identity(b);
}

bool less(const ContactPoint& a, const ContactPoint& b) {
  return identity(a) < identity(b);
}

bool nearer(const ContactPoint& a, const ContactPoint& b) {
  return a.gap < b.gap;
}

/// By identity, and the nearest first among those of one.
bool before(const ContactPoint& a, const ContactPoint& b) {
  return same(a, b) ? a.gap < b.gap : less(a, b);
}

}  // namespace

ContactList::ContactList() {
  contacts_.reserve(kMaxContacts);
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

void ContactList::add(const ContactPoint& contact) noexcept {
  if (contacts_.size() == kMaxContacts) {
    if (!nearer(contact, contacts_.front())) return;
    std::pop_heap(contacts_.begin(), contacts_.end(), nearer);
    contacts_.pop_back();
  }
  contacts_.push_back(contact);
  std::push_heap(contacts_.begin(), contacts_.end(), nearer);
}

void ContactList::gather(const std::vector<Contact>& constraints, const TickReport& report,
                         const Vec3& center_W) noexcept {
  contacts_.clear();
  const ContactForces& forces = report.forces;
  const ContactForce* const end = forces.items.data() + forces.count;
  const auto carries = [&forces, end](const Contact& c) {
    return std::any_of(forces.items.data(), end, [&c](const ContactForce& f) {
      return f.part == c.part && f.feature_a == c.feature_a && f.feature_b == c.feature_b;
    });
  };
  for (const Contact& c : constraints) {
    if (c.age == kOneShotAge || (c.gap > report.contact_gap && !carries(c))) continue;
    ContactPoint p{c.part, c.feature_a, c.feature_b, center_W + c.r, Vec3::Zero(), c.n, c.gap, {}, Vec3::Zero(), false,
                   0};
    p.point_b = p.point_a - c.gap * c.n;
    if (forces.available) p.force = 0;
    add(p);
  }
  std::sort(contacts_.begin(), contacts_.end(), before);
  contacts_.erase(std::unique(contacts_.begin(), contacts_.end(), same), contacts_.end());
  for (const ContactForce* f = forces.items.data(); f != end; ++f) {
    ContactPoint wanted;
    wanted.part = f->part;
    wanted.feature_a = f->feature_a;
    wanted.feature_b = f->feature_b;
    const auto at = std::lower_bound(contacts_.begin(), contacts_.end(), wanted, less);
    if (at == contacts_.end() || !same(*at, wanted)) continue;
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
