/// Private to this room: a mask asked by leaves and by aligned regions of 8^3, 128^3 or 4096^3 voxels. Work grows with its nodes there.
#pragma once
#include "engine/field/nano_build.h"
#include "engine/field/nano_stats.h"

namespace catena::field {

class MaskView {
 public:
  explicit MaskView(const NanoMask& mask) : accessor_(mask), root_(mask.tree().root()) {}

  /// The 64 voxels of layer x (0 to 7) of the block at `origin`, as a leaf's mask has them.
  std::uint64_t word(const nanovdb::Coord& origin, int x) const {
    if (const auto* leaf = accessor_.probeLeaf(origin)) return leaf->valueMask().getWord<std::uint64_t>(x);
    return accessor_.getValue(origin) ? ~std::uint64_t{0} : 0;
  }
  /// Some voxel of the region is on.
  bool any(const nanovdb::Coord& origin, std::int32_t edge) const { return find<true>(origin, edge); }
  /// Every voxel of the region is on.
  bool all(const nanovdb::Coord& origin, std::int32_t edge) const { return !find<false>(origin, edge); }

 private:
  using Upper = NanoTypes<nanovdb::ValueMask>::Upper;
  using Lower = NanoTypes<nanovdb::ValueMask>::Lower;
  using Leaf = NanoTypes<nanovdb::ValueMask>::Leaf;

  template <bool kOn>
  bool find(const nanovdb::Coord& origin, std::int32_t edge) const {
    const auto* entry = root_.probeTile(origin);
    if (entry == nullptr) return !kOn;
    if (entry->isValue()) return entry->value == kOn;
    const auto& upper = *reinterpret_cast<const Upper*>(root_.data()->getChild(entry));
    if (edge == kLowerEdge) return in_upper<kOn>(upper, upper_entry(origin));
    if (edge == kUpperEdge) {
      for (std::uint32_t n = 0; n < kUpperEntries; ++n)
        if (in_upper<kOn>(upper, n)) return true;
      return false;
    }
    const std::uint32_t n = upper_entry(origin);
    if (!upper.mChildMask.isOn(n)) return upper.mTable[n].value == kOn;
    return in_lower<kOn>(*reinterpret_cast<const Lower*>(upper.getChild(n)), lower_entry(origin));
  }
  template <bool kOn>
  static bool in_upper(const Upper& upper, std::uint32_t n) {
    if (!upper.mChildMask.isOn(n)) return upper.mTable[n].value == kOn;
    const auto& lower = *reinterpret_cast<const Lower*>(upper.getChild(n));
    for (std::uint32_t m = 0; m < kLowerEntries; ++m)
      if (in_lower<kOn>(lower, m)) return true;
    return false;
  }
  template <bool kOn>
  static bool in_lower(const Lower& lower, std::uint32_t n) {
    if (!lower.mChildMask.isOn(n)) return lower.mTable[n].value == kOn;
    const auto& mask = reinterpret_cast<const Leaf*>(lower.getChild(n))->mValueMask;
    return kOn ? !mask.isOff() : !mask.isOn();
  }

  nanovdb::ReadAccessor<nanovdb::ValueMask, 0, 1, 2> accessor_;
  const nanovdb::NanoRoot<nanovdb::ValueMask>& root_;
};

}  // namespace catena::field
