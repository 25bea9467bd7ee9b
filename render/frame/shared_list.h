/// A list that copies share until one of them changes it: frame packets and passes keep long lines without holding them twice. Elements are
/// read only; a list changes by being assigned, or grown by its one owner. Reading is safe on any thread.
#pragma once
#include <algorithm>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace catena::render {

template <class T>
class SharedList {
 public:
  using value_type = T;
  SharedList() = default;
  SharedList(std::initializer_list<T> items) : SharedList(std::vector<T>(items)) {}
  SharedList(std::vector<T> items) : items_(items.empty() ? nullptr : std::make_shared<std::vector<T>>(std::move(items))) {}

  const std::vector<T>& list() const {
    static const std::vector<T> none;
    return items_ ? *items_ : none;
  }
  auto begin() const { return list().begin(); }
  auto end() const { return list().end(); }
  std::size_t size() const { return list().size(); }
  bool empty() const { return list().empty(); }
  const T& operator[](std::size_t i) const { return list()[i]; }
  const T& front() const { return list().front(); }
  const T& back() const { return list().back(); }
  void push_back(const T& item) { own().push_back(item); }
  /// One list in memory: nothing has to be compared.
  bool is_same(const SharedList& other) const { return items_ == other.items_; }
  friend bool operator==(const SharedList& a, const SharedList& b) { return a.is_same(b) || a.list() == b.list(); }

 private:
  std::vector<T>& own() {
    if (!items_ || items_.use_count() > 1) items_ = std::make_shared<std::vector<T>>(list());
    return *items_;
  }
  std::shared_ptr<std::vector<T>> items_;
};

}  // namespace catena::render
