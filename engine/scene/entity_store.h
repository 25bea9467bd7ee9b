// SPDX-License-Identifier: MIT
/// Entity-component store: entities are numbers, components are plain structs in sparse sets, systems are free functions over them.
/// Frame thread only.
#pragma once
#include <cstdint>
#include <memory>
#include <typeindex>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/base/result.h"

namespace catena::scene {

/// Identifier of an entity in a store. Converts to false if it refers to none.
struct Entity {
  std::uint32_t id = 0xffffffffu;  ///< Unique within its store; 0xffffffff: none
  bool operator==(const Entity&) const = default;
  /// Returns whether it refers to an entity.
  explicit operator bool() const { return id != 0xffffffffu; }
};

/// Components of one type as a sparse set: dense arrays of owners and components, in order of insertion until a component is removed.
template <class T>
class ComponentPool {
 public:
  /// Adds a component. Precondition: the entity has none.
  T& emplace(Entity e, T value) {
    CATENA_ASSERT(!contains(e));
    if (sparse_.size() <= e.id) sparse_.resize(e.id + 1, kNone);
    sparse_[e.id] = static_cast<std::uint32_t>(dense_.size());
    owners_.push_back(e);
    dense_.push_back(std::move(value));
    return dense_.back();
  }
  /// Returns whether the entity has a component.
  bool contains(Entity e) const { return e.id < sparse_.size() && sparse_[e.id] != kNone; }
  /// Returns the entity's component. Precondition: it has one.
  T& get(Entity e) {
    CATENA_ASSERT(contains(e));
    return dense_[sparse_[e.id]];
  }
  /// Returns the entity's component. Precondition: it has one.
  const T& get(Entity e) const {
    CATENA_ASSERT(contains(e));
    return dense_[sparse_[e.id]];
  }
  /// Removes the entity's component, if any. The last component of the pool takes its slot.
  void remove(Entity e) {
    if (!contains(e)) return;
    const std::uint32_t hole = sparse_[e.id];
    dense_[hole] = std::move(dense_.back());
    owners_[hole] = owners_.back();
    sparse_[owners_[hole].id] = hole;
    sparse_[e.id] = kNone;
    dense_.pop_back();
    owners_.pop_back();
  }
  /// Returns the number of components.
  std::size_t size() const { return dense_.size(); }
  /// Returns the entities that have a component, in the order of the pool.
  const std::vector<Entity>& owners() const { return owners_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> sparse_;
  std::vector<Entity> owners_;
  std::vector<T> dense_;
};

/// Entities with their components of any types.
class EntityStore {
 public:
  /// Creates an entity without components.
  Entity create() { return Entity{next_++}; }

  /// Adds a T. Precondition: the entity has none.
  template <class T>
  T& emplace(Entity e, T value = {}) {
    return pool<T>().emplace(e, std::move(value));
  }
  /// Returns whether the entity has a T.
  template <class T>
  bool has(Entity e) const {
    const auto* p = find_pool<T>();
    return p != nullptr && p->contains(e);
  }
  /// Returns the entity's T, which must exist. References are valid until a T is added or removed.
  template <class T>
  T& get(Entity e) {
    return pool<T>().get(e);
  }
  /// Returns the entity's T, which must exist.
  template <class T>
  const T& get(Entity e) const {
    const auto* p = find_pool<T>();
    CATENA_ASSERT(p != nullptr);
    return p->get(e);
  }
  /// Removes the entity's T, if any.
  template <class T>
  void remove(Entity e) {
    pool<T>().remove(e);
  }
  /// Moves the components of entity `there` of the store `other` to entity `here` of this store, except for types that `here` already has.
  void move_missing_from(Entity here, EntityStore& other, Entity there) {
    for (auto& [type, slot] : other.pools_) {
      auto& target = pools_[type];
      if (!target) target = slot->make_empty();
      target->move_from(here, *slot, there);
    }
  }
  /// Returns the number of entities that have a T.
  template <class T>
  std::size_t count() const {
    const auto* p = find_pool<T>();
    return p == nullptr ? 0 : p->size();
  }
  /// Calls f(entity, T&) for each owner of a T, in the order of the pool. f must not add or remove Ts.
  template <class T, class F>
  void each(F&& f) {
    for (Entity e : pool<T>().owners()) f(e, pool<T>().get(e));
  }
  /// Calls f(entity, const T&) for each owner of a T, in the order of the pool.
  template <class T, class F>
  void each(F&& f) const {
    if (const auto* p = find_pool<T>())
      for (Entity e : p->owners()) f(e, p->get(e));
  }

 private:
  struct Slot {
    virtual ~Slot() = default;
    virtual std::unique_ptr<Slot> make_empty() const = 0;
    virtual void move_from(Entity here, Slot& other, Entity there) = 0;  ///< Precondition: `other` holds the same type
  };
  template <class T>
  struct TypedSlot final : Slot {
    std::unique_ptr<Slot> make_empty() const override { return std::make_unique<TypedSlot>(); }
    void move_from(Entity here, Slot& other, Entity there) override {
      ComponentPool<T>& from = static_cast<TypedSlot&>(other).pool;
      if (!from.contains(there) || pool.contains(here)) return;
      pool.emplace(here, std::move(from.get(there)));
      from.remove(there);
    }
    ComponentPool<T> pool;
  };
  template <class T>
  ComponentPool<T>& pool() {
    auto& slot = pools_[std::type_index(typeid(T))];
    if (!slot) slot = std::make_unique<TypedSlot<T>>();
    return static_cast<TypedSlot<T>&>(*slot).pool;
  }
  template <class T>
  const ComponentPool<T>* find_pool() const {
    const auto it = pools_.find(std::type_index(typeid(T)));
    return it == pools_.end() ? nullptr : &static_cast<const TypedSlot<T>&>(*it->second).pool;
  }

  std::uint32_t next_ = 0;
  std::unordered_map<std::type_index, std::unique_ptr<Slot>> pools_;
};

}  // namespace catena::scene
