/// From UTF-8 to glyphs in place and their pictures. Frame thread.
#pragma once
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "render/text/font.h"

namespace catena::render {

/// UTF-8 to code points. What is no UTF-8 becomes U+FFFD, one for each byte that fits nowhere. Any thread.
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

/// Rasterised glyphs side by side in one coverage image: rows ("shelves") of equal height, growing downwards. A glyph is made once for
/// its font, size, quarter of a pixel and halo. When the image is full it starts anew: what was placed before is void. Frame thread.
class GlyphAtlas {
 public:
  struct Entry {
    int x = 0, y = 0, width = 0, height = 0;  ///< in the image
    int left = 0, top = 0;                    ///< of the bitmap's corner, from the pen
  };
  static constexpr int kWidth = 1024, kMaxHeight = 4096;

  /// The glyph with its pen at `quarter` / 4 of a pixel. Nothing if it is larger than the whole image.
  const Entry* get(const Font& font, std::uint32_t glyph, double size_px, int quarter, double halo_px);

  /// Starts anew.
  void clear();

  int height() const { return height_; }
  const std::vector<std::uint8_t>& pixels() const { return pixels_; }  ///< kWidth x height()
  std::uint64_t version() const { return version_; }                   ///< rises with every new glyph
  std::uint64_t generation() const { return generation_; }             ///< rises when the image starts anew

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

struct TextStyle {
  double size_px = 16;
  bool bold = false;
  double align = 0;  ///< of several lines: 0 left, 0.5 centred, 1 right
};

struct TextExtent {
  double width = 0, height = 0;
  double descent = 0;  ///< below the box
};

/// A glyph's pen on its baseline, from the box's top left corner.
struct PlacedGlyph {
  std::uint32_t glyph = 0;
  double x = 0, y = 0;
};

struct TextLayout {
  std::vector<PlacedGlyph> glyphs;
  TextExtent extent;
};

/// UTF-8 text to placed glyphs. A text's box reaches from the capitals' height of its first line to the baseline of its last, and is
/// as wide as its widest line's advances: what is centred by it looks centred, descenders hang below. Pixels, x right, y down.
/// Fonts are opened when first used. Without a font everything has no extent and no glyphs, and `fault` says why. Frame thread.
class Typesetter {
 public:
  /// Another family drops the fonts (and so the atlas).
  void set_family(const std::string& family);
  TextLayout layout(std::string_view text, const TextStyle& style);
  TextExtent measure(std::string_view text, const TextStyle& style) { return layout(text, style).extent; }
  /// The font of a style, or none.
  const Font* font(bool bold);
  GlyphAtlas& atlas() { return atlas_; }
  /// One sentence, once a font was asked for that is not there.
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
