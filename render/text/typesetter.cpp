// SPDX-License-Identifier: MIT
#include "render/text/typesetter.h"

#include <algorithm>
#include <cmath>

namespace catena::render {

namespace {

constexpr int kFirstHeight = 128;
constexpr int kShelfStep = 4;  // shelf heights are rounded up to a multiple

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

bool GlyphAtlas::allocate(Entry& entry) {
  const int rows = (entry.height + kShelfStep - 1) / kShelfStep * kShelfStep;
  for (Shelf& shelf : shelves_) {
    if (shelf.height != rows || shelf.used + entry.width > kWidth) continue;
    entry.x = shelf.used;
    entry.y = shelf.y;
    shelf.used += entry.width;
    return true;
  }
  const int y = shelves_.empty() ? 0 : shelves_.back().y + shelves_.back().height;
  if (y + rows > kMaxHeight) return false;
  if (y + rows > height_) {
    int next = std::max(kFirstHeight, height_);
    while (next < y + rows) next *= 2;
    grow(std::min(next, kMaxHeight));
  }
  shelves_.push_back({y, rows, entry.width});
  entry.x = 0;
  entry.y = y;
  return true;
}

const GlyphAtlas::Entry* GlyphAtlas::get(const Font& font, std::uint32_t glyph, double size_px, int quarter, double halo_px) {
  const Key key{&font, glyph, std::lround(64 * size_px), std::lround(64 * halo_px), quarter};
  if (const auto it = entries_.find(key); it != entries_.end()) return &it->second;
  const GlyphBitmap bitmap = font.rasterize(glyph, size_px, 0.25 * quarter, halo_px);
  Entry entry{0, 0, bitmap.width, bitmap.height, bitmap.left, bitmap.top};
  if (entry.width > kWidth || entry.height > kMaxHeight) return nullptr;
  if (entry.width > 0 && !allocate(entry)) {
    clear();
    if (!allocate(entry)) return nullptr;
  }
  for (int y = 0; y < entry.height; ++y)
    std::copy_n(bitmap.coverage.begin() + static_cast<std::ptrdiff_t>(y) * entry.width, entry.width,
                pixels_.begin() + static_cast<std::ptrdiff_t>(entry.y + y) * kWidth + entry.x);
  ++version_;
  return &(entries_[key] = entry);
}

void Typesetter::set_family(const std::string& family) {
  if (family == family_) return;
  family_ = family;
  error_message_.clear();
  atlas_.clear();
  for (Face& face : faces_) face = {};
}

const Font* Typesetter::font(bool bold) {
  Face& face = faces_[bold ? 1 : 0];
  if (!face.load_attempted) {
    face.load_attempted = true;
    const auto open = [&]() -> Result<Font> {
      CATENA_TRY(const FontFile file, find_font(family_, bold));
      return Font::open(file);
    };
    if (auto font = open()) {
      face.font = std::make_unique<Font>(std::move(*font));
    } else {
      error_message_ = font.error().message;
    }
  }
  return face.font.get();
}

TextLayout Typesetter::layout(std::string_view text, const TextStyle& style) {
  TextLayout out;
  const Font* font = this->font(style.bold);
  if (font == nullptr || text.empty()) return out;
  const FontMetrics measures = font->metrics(style.size_px);

  // left-aligned lines
  std::vector<std::size_t> line_starts{0};
  std::vector<double> widths;
  double x = 0, y = measures.cap_height;
  std::uint32_t before = 0;
  for (const char32_t code : decode_utf8(text)) {
    if (code == U'\n') {
      widths.push_back(x);
      line_starts.push_back(out.glyphs.size());
      x = 0;
      y += measures.line_height;
      before = 0;
      continue;
    }
    const std::uint32_t glyph = font->glyph_index(code);
    if (before != 0) x += font->kerning(before, glyph, style.size_px);
    out.glyphs.push_back({glyph, x, y});
    x += font->advance(glyph, style.size_px);
    before = glyph;
  }
  widths.push_back(x);
  line_starts.push_back(out.glyphs.size());
  out.extent = {*std::max_element(widths.begin(), widths.end()), y, measures.descent};

  // horizontal alignment
  for (std::size_t line = 0; line < widths.size(); ++line)
    for (std::size_t i = line_starts[line]; i < line_starts[line + 1]; ++i)
      out.glyphs[i].x += style.align * (out.extent.width - widths[line]);
  return out;
}

}  // namespace catena::render
