#pragma once

#include <cstdint>
#include <vector>

#include "tegotae/contact/contact_point.hpp"
#include "tegotae/loop/haptic_loop.hpp"

namespace tegotae {

/// The contacts of the last tick, constraints with a gap of at most TickReport::contact_gap or a force, and which began
/// and ended in it. Allocates only when it is made.
class ContactList {
 public:
  /// Contacts that are listed; of more the nearest are.
  static constexpr std::size_t kMaxContacts = 1024;

  ContactList();
  /// After a tick that left `constraints`, and the held part's center of mass at `center_W`. Of constraints that name
  /// the same features the nearest is the contact.
  void update(const std::vector<Contact>& constraints, const TickReport& report, const Vec3& center_W) noexcept;
  /// Forgets all contacts, without events.
  void clear() noexcept;

  const std::vector<ContactPoint>& contacts() const { return contacts_; }  ///< by part and features
  const std::vector<ContactEvent>& events() const { return events_; }      ///< in the same order

 private:
  void list(const std::vector<Contact>& constraints, std::uint32_t which) noexcept;
  void gather(const std::vector<Contact>& constraints, const TickReport& report, const Vec3& center_W) noexcept;
  void compare() noexcept;

  std::vector<ContactPoint> contacts_, before_;
  std::vector<std::uint32_t> listed_;  ///< scratch: numbers of constraints
  std::vector<ContactEvent> events_;
};

}  // namespace tegotae
