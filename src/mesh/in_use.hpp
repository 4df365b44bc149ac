#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace tegotae {

/// Values that live as long as somebody uses them, by a key that begins with the address of what they are made of. A
/// value keeps that alive, so as long as there is one nothing else has its address.
template <typename Key, typename T>
class InUse {
 public:
  /// The value in use, or the one that `make` makes (a shared pointer). Several threads may ask at once.
  template <typename Make>
  std::shared_ptr<const T> get(const Key& key, const Make& make) {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      for (auto i = known_.begin(); i != known_.end();) i = i->second.expired() ? known_.erase(i) : std::next(i);
      const auto known = known_.find(key);
      if (known != known_.end())
        if (auto value = known->second.lock()) return value;
    }
    std::shared_ptr<const T> value = make();
    const std::lock_guard<std::mutex> lock(mutex_);
    known_[key] = value;
    return value;
  }

 private:
  std::mutex mutex_;
  std::map<Key, std::weak_ptr<const T>> known_;
};

}  // namespace tegotae
