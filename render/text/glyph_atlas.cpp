#include "render/text/glyph_atlas.h"

#include <algorithm>
#include <cmath>

namespace catena::render {
namespace {

constexpr int kFirstHeight = 128;
constexpr int kShelfStep = 4;  // shelves' heights are rounded up to it

}  // namespace

void GlyphAtlas::grow(int height) {
  height_ = height;
  pixels_.resize(static_cast<std::size_t>(kWidth) * static_cast<std::size_t>(height_), 0);
}

void GlyphAtlas::clear() {
  entries_.clear();
  shelves_.clear();
  std::fill(pixels_.begin(), pixels_.end(), std::uint8_t{0});
  ++generation_;
  ++version_;
}

bool GlyphAtlas::place(Entry& entry) {
  const int rows = (entry.height + kShelfStep - 1) / kShelfStep * kShelfStep;
  for (Shelf& shelf : shelves_) {
    if (shelf.height != rows || shelf.used + entry.width > kWidth) continue;
    entry.x = shelf.used;
    entry.y = shelf.y;
    shelf.used += entry.width;
    return true;
  }
  const int y = shelves_.empty() ? 0 : shelves_.back().y + shelves_.back().height;
  if (y + rows > kMostHeight) return false;
  if (y + rows > height_) {
    int next = std::max(kFirstHeight, height_);
    while (next < y + rows) next *= 2;
    grow(std::min(next, kMostHeight));
  }
  shelves_.push_back({y, rows, entry.width});
  entry.x = 0;
  entry.y = y;
  return true;
}

const GlyphAtlas::Entry* GlyphAtlas::get(const Font& font, std::uint32_t glyph, double size_px, int quarter, double halo_px) {
  const Key key{&font, glyph, std::lround(64 * size_px), std::lround(64 * halo_px), quarter};
  if (const auto it = entries_.find(key); it != entries_.end()) return &it->second;
  const GlyphBitmap bitmap = font.rasterise(glyph, size_px, 0.25 * quarter, halo_px);
  Entry entry{0, 0, bitmap.width, bitmap.height, bitmap.left, bitmap.top};
  if (entry.width > kWidth || entry.height > kMostHeight) return nullptr;
  if (entry.width > 0 && !place(entry)) {
    clear();
    if (!place(entry)) return nullptr;
  }
  for (int y = 0; y < entry.height; ++y)
    std::copy_n(bitmap.coverage.begin() + static_cast<std::ptrdiff_t>(y) * entry.width, entry.width,
                pixels_.begin() + static_cast<std::ptrdiff_t>(entry.y + y) * kWidth + entry.x);
  ++version_;
  return &(entries_[key] = entry);
}

}  // namespace catena::render
