// SPDX-License-Identifier: MIT
/// Typesetting: from UTF-8 to positioned glyphs, and the atlas of their bitmaps. Frame thread.
#pragma once
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "render/text/font.h"

namespace catena::render {

/// Decodes UTF-8 to code points. Invalid input becomes U+FFFD, one for each byte that belongs to no valid sequence. Any thread.
inline std::vector<char32_t> decode_utf8(std::string_view text) {
  constexpr char32_t bad = 0xfffd;
  std::vector<char32_t> out;
  for (std::size_t i = 0; i < text.size();) {
    const auto first = static_cast<unsigned char>(text[i++]);
    const int more = first < 0x80                    ? 0
                     : first >= 0xc2 && first < 0xe0 ? 1
                     : first >= 0xe0 && first < 0xf0 ? 2
                     : first >= 0xf0 && first < 0xf5 ? 3
                                                     : -1;
    if (more < 0) {
      out.push_back(bad);
      continue;
    }
    char32_t c = more == 0 ? first : static_cast<char32_t>(first & (0x3f >> more));
    bool whole = text.size() - i >= static_cast<std::size_t>(more);
    for (int k = 0; k < more && whole; ++k) {
      const auto next = static_cast<unsigned char>(text[i + static_cast<std::size_t>(k)]);
      whole = (next & 0xc0) == 0x80;
      c = (c << 6) | (next & 0x3f);
    }
    // overlong forms, surrogates, beyond the last plane
    whole = whole && !(more == 2 && c < 0x800) && !(more == 3 && (c < 0x10000 || c > 0x10ffff)) && !(c >= 0xd800 && c < 0xe000);
    if (whole) i += static_cast<std::size_t>(more);
    out.push_back(whole ? c : bad);
  }
  return out;
}

/// Atlas of rasterized glyphs in one coverage image: rows ("shelves") of equal height, growing downwards. A glyph is rasterized once per
/// font, size, quarter of a pixel and halo. When the image is full, it is cleared, which invalidates all earlier entries. Frame thread.
class GlyphAtlas {
 public:
  /// Position of a glyph in the atlas.
  struct Entry {
    int x = 0, y = 0, width = 0, height = 0;  ///< rectangle in the image, pixels
    int left = 0, top = 0;                    ///< offset of the bitmap's upper left corner from the pen
  };
  static constexpr int kWidth = 1024, kMaxHeight = 4096;

  /// Returns the glyph with its pen at `quarter` / 4 of a pixel. Null if it is larger than the whole image.
  const Entry* get(const Font& font, std::uint32_t glyph, double size_px, int quarter, double halo_px);

  /// Clears the atlas.
  void clear();

  int height() const { return height_; }
  const std::vector<std::uint8_t>& pixels() const { return pixels_; }  ///< kWidth x height() pixels
  std::uint64_t version() const { return version_; }                   ///< increases with every new glyph
  std::uint64_t generation() const { return generation_; }             ///< increases when the image is cleared

 private:
  struct Key {
    const Font* font;
    std::uint32_t glyph;
    long size, halo;  // 1/64 pixel
    int subpixel_quarter;
    auto operator<=>(const Key&) const = default;
  };
  struct Shelf {
    int y, height, used;
  };
  bool allocate(Entry& entry);
  void grow(int height);

  std::map<Key, Entry> entries_;
  std::vector<Shelf> shelves_;
  std::vector<std::uint8_t> pixels_;
  int height_ = 0;
  std::uint64_t version_ = 0, generation_ = 0;
};

/// Style of a text.
struct TextStyle {
  double size_px = 16;
  bool bold = false;
  double align = 0;  ///< alignment of several lines: 0 left, 0.5 centered, 1 right
};

/// Size of a text's box, pixels.
struct TextExtent {
  double width = 0, height = 0;
  double descent = 0;  ///< depth of descenders below the box
};

/// Glyph with its pen position on the baseline, relative to the box's top left corner.
struct PlacedGlyph {
  std::uint32_t glyph = 0;
  double x = 0, y = 0;
};

/// Positioned glyphs of a text.
struct TextLayout {
  std::vector<PlacedGlyph> glyphs;
  TextExtent extent;
};

/// Typesets UTF-8 text. A text's box reaches from the cap height of its first line to the baseline of its last, and is as wide as the
/// advances of its widest line: text centered by this box looks centered, descenders hang below. Pixels, x right, y down. Fonts are opened
/// on first use. Without a font, texts have no extent and no glyphs, and error_message() gives the reason. Frame thread.
class Typesetter {
 public:
  /// Sets the font family; another family drops the fonts and clears the atlas.
  void set_family(const std::string& family);
  /// Returns the glyphs of a text with their positions, and its box.
  TextLayout layout(std::string_view text, const TextStyle& style);
  TextExtent measure(std::string_view text, const TextStyle& style) { return layout(text, style).extent; }
  /// Returns the font of a style; null if there is none.
  const Font* font(bool bold);
  GlyphAtlas& atlas() { return atlas_; }
  /// Returns a one-line message if a requested font could not be loaded; empty: none.
  const std::string& error_message() const { return error_message_; }

 private:
  struct Face {
    bool load_attempted = false;
    std::unique_ptr<Font> font;
  };
  std::string family_ = "DejaVu Sans", error_message_;
  Face faces_[2];
  GlyphAtlas atlas_;
};

}  // namespace catena::render
