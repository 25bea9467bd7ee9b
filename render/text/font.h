/// One font file, its measures and its glyphs as coverage bitmaps (FreeType). Outlines are hinted vertically only: positions along the
/// line are exact. Sizes in pixels an em, positions in pixels, x right; "top" counts upwards from the baseline. Frame thread.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::render {

/// The file of the installed font that is nearest to a family ("DejaVu Sans"), by fontconfig. An error says what to install.
struct FontFile {
  std::string path;
  int index = 0;  ///< of the face within the file
};
Result<FontFile> find_font(const std::string& family, bool bold);

struct FontMetrics {
  double cap_height = 0;   ///< of capitals and digits above the baseline
  double descent = 0;      ///< below the baseline, positive
  double line_height = 0;  ///< from baseline to baseline
};

struct GlyphBitmap {
  int width = 0, height = 0;
  int left = 0, top = 0;               ///< of the bitmap's corner, from the pen
  std::vector<std::uint8_t> coverage;  ///< rows from the top; 255: covered
};

class Font {
 public:
  static Result<Font> open(const FontFile& file);
  ~Font();
  Font(Font&&) noexcept;
  Font& operator=(Font&&) noexcept;

  FontMetrics metrics(double size_px) const;
  /// 0 (an empty box is drawn) where the font has no glyph for it.
  std::uint32_t glyph_index(char32_t code) const;
  double advance(std::uint32_t glyph, double size_px) const;
  /// To be added between two glyphs; 0 if the font has no kerning.
  double kerning(std::uint32_t left, std::uint32_t right, double size_px) const;
  /// The glyph with its pen `shift_px` right of a pixel's edge; widened by `halo_px` on all sides. Empty for blanks.
  GlyphBitmap rasterize(std::uint32_t glyph, double size_px, double shift_px, double halo_px) const;

 private:
  Font();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace catena::render
