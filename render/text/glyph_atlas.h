/// Rasterised glyphs side by side in one coverage image: rows ("shelves") of equal height, growing downwards. A glyph is made once for
/// its font, size, quarter of a pixel and halo. When the image is full it starts anew: what was placed before is void. Frame thread.
#pragma once
#include <map>

#include "render/text/font.h"

namespace catena::render {

class GlyphAtlas {
 public:
  struct Entry {
    int x = 0, y = 0, width = 0, height = 0;  ///< in the image
    int left = 0, top = 0;                    ///< of the bitmap's corner, from the pen
  };
  static constexpr int kWidth = 1024, kMostHeight = 4096;

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
    int quarter;
    auto operator<=>(const Key&) const = default;
  };
  struct Shelf {
    int y, height, used;
  };
  bool place(Entry& entry);
  void grow(int height);

  std::map<Key, Entry> entries_;
  std::vector<Shelf> shelves_;
  std::vector<std::uint8_t> pixels_;
  int height_ = 0;
  std::uint64_t version_ = 0, generation_ = 0;
};

}  // namespace catena::render
