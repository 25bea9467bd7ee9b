// SPDX-License-Identifier: MIT
#include "render/text/font.h"

#include <fontconfig/fontconfig.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_GLYPH_H
#include FT_OUTLINE_H
#include FT_STROKER_H
#include FT_TRUETYPE_TABLES_H

#include <cmath>

#include "engine/base/result.h"

namespace catena::render {
namespace {

constexpr double kUnit = 64;                      // FreeType's 26.6 fixed point: units per pixel
constexpr FT_Int32 kUnscaled = FT_LOAD_NO_SCALE;  // measures in font units
constexpr FT_Int32 kHinted = FT_LOAD_TARGET_LIGHT | FT_LOAD_NO_BITMAP;

FT_F26Dot6 fixed(double px) { return static_cast<FT_F26Dot6>(std::lround(kUnit * px)); }

struct GlyphOwner {
  FT_Glyph glyph = nullptr;
  ~GlyphOwner() {
    if (glyph != nullptr) FT_Done_Glyph(glyph);
  }
};

}  // namespace

struct Font::Impl {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  FT_Stroker stroker = nullptr;
  double cap_height = 0;  // in font units

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (stroker != nullptr) FT_Stroker_Done(stroker);
    if (face != nullptr) FT_Done_Face(face);
    if (library != nullptr) FT_Done_FreeType(library);
  }
  double per_unit(double size_px) const { return size_px / face->units_per_EM; }
  void set_size(double size_px) const { FT_Set_Char_Size(face, 0, std::max<FT_F26Dot6>(1, fixed(size_px)), 72, 72); }
};

Font::Font() : impl_(std::make_unique<Impl>()) {}
Font::~Font() = default;
Font::Font(Font&&) noexcept = default;
Font& Font::operator=(Font&&) noexcept = default;

Result<Font> Font::open(const FontFile& file) {
  Font self;
  Impl& p = *self.impl_;
  const bool good = FT_Init_FreeType(&p.library) == 0 && FT_New_Face(p.library, file.path.c_str(), file.index, &p.face) == 0 &&
                    FT_IS_SCALABLE(p.face) && p.face->units_per_EM > 0 && FT_Stroker_New(p.library, &p.stroker) == 0;
  if (!good) return Error{file.path + ": the font cannot be read: text is left out; a TrueType or OpenType font was expected"};
  const auto* os2 = static_cast<const TT_OS2*>(FT_Get_Sfnt_Table(p.face, FT_SFNT_OS2));
  if (os2 != nullptr && os2->version >= 2 && os2->sCapHeight > 0) {
    p.cap_height = os2->sCapHeight;
  } else if (FT_Load_Char(p.face, 'H', kUnscaled) == 0) {
    p.cap_height = static_cast<double>(p.face->glyph->metrics.horiBearingY);
  }
  return self;
}

FontMetrics Font::metrics(double size_px) const {
  const double unit = impl_->per_unit(size_px);
  return {unit * impl_->cap_height, -unit * impl_->face->descender, unit * impl_->face->height};
}

std::uint32_t Font::glyph_index(char32_t code) const { return FT_Get_Char_Index(impl_->face, code); }

double Font::advance(std::uint32_t glyph, double size_px) const {
  if (FT_Load_Glyph(impl_->face, glyph, kUnscaled) != 0) return 0;
  return impl_->per_unit(size_px) * static_cast<double>(impl_->face->glyph->metrics.horiAdvance);
}

double Font::kerning(std::uint32_t left, std::uint32_t right, double size_px) const {
  FT_Vector by{};
  if (!FT_HAS_KERNING(impl_->face) || FT_Get_Kerning(impl_->face, left, right, FT_KERNING_UNSCALED, &by) != 0) return 0;
  return impl_->per_unit(size_px) * static_cast<double>(by.x);
}

GlyphBitmap Font::rasterize(std::uint32_t glyph, double size_px, double shift_px, double halo_px) const {
  const FT_Face face = impl_->face;
  impl_->set_size(size_px);
  GlyphOwner owner;
  if (FT_Load_Glyph(face, glyph, kHinted) != 0 || face->glyph->format != FT_GLYPH_FORMAT_OUTLINE ||
      FT_Get_Glyph(face->glyph, &owner.glyph) != 0)
    return {};
  if (halo_px > 0) {
    FT_Stroker_Set(impl_->stroker, fixed(halo_px), FT_STROKER_LINECAP_ROUND, FT_STROKER_LINEJOIN_ROUND, 0);
    if (FT_Glyph_StrokeBorder(&owner.glyph, impl_->stroker, 0, 1) != 0) return {};
  }
  FT_Vector shift{fixed(shift_px), 0};
  if (FT_Glyph_To_Bitmap(&owner.glyph, FT_RENDER_MODE_NORMAL, &shift, 1) != 0) return {};
  const auto* made = reinterpret_cast<const FT_BitmapGlyphRec*>(owner.glyph);
  GlyphBitmap out;
  out.width = static_cast<int>(made->bitmap.width);
  out.height = static_cast<int>(made->bitmap.rows);
  out.left = made->left;
  out.top = made->top;
  CATENA_ASSERT(out.width == 0 || made->bitmap.pixel_mode == FT_PIXEL_MODE_GRAY);
  for (int y = 0; y < out.height; ++y) {
    const unsigned char* row = made->bitmap.buffer + static_cast<std::ptrdiff_t>(y) * made->bitmap.pitch;
    out.coverage.insert(out.coverage.end(), row, row + out.width);
  }
  return out;
}

Result<FontFile> find_font(const std::string& family, bool bold) {
  const auto nothing = [&] {
    return Error{"no font was found for \"" + family + "\": text is left out; an installed font was expected (Debian: fonts-dejavu-core)"};
  };
  const auto text = [](const char* word) { return reinterpret_cast<const FcChar8*>(word); };
  const std::unique_ptr<FcConfig, void (*)(FcConfig*)> config(FcInitLoadConfigAndFonts(), FcConfigDestroy);
  const std::unique_ptr<FcPattern, void (*)(FcPattern*)> wanted(FcPatternCreate(), FcPatternDestroy);
  if (!config || !wanted) return nothing();
  FcPatternAddString(wanted.get(), FC_FAMILY, text(family.c_str()));
  FcPatternAddString(wanted.get(), FC_FAMILY, text("DejaVu Sans"));
  FcPatternAddString(wanted.get(), FC_FAMILY, text("sans-serif"));
  FcPatternAddInteger(wanted.get(), FC_WEIGHT, bold ? FC_WEIGHT_BOLD : FC_WEIGHT_REGULAR);
  FcPatternAddBool(wanted.get(), FC_OUTLINE, FcTrue);
  FcConfigSubstitute(config.get(), wanted.get(), FcMatchPattern);
  FcDefaultSubstitute(wanted.get());
  FcResult found = FcResultNoMatch;
  const std::unique_ptr<FcPattern, void (*)(FcPattern*)> match(FcFontMatch(config.get(), wanted.get(), &found), FcPatternDestroy);
  FcChar8* path = nullptr;
  FontFile file;
  if (!match || FcPatternGetString(match.get(), FC_FILE, 0, &path) != FcResultMatch) return nothing();
  if (FcPatternGetInteger(match.get(), FC_INDEX, 0, &file.index) != FcResultMatch) file.index = 0;
  file.path = reinterpret_cast<const char*>(path);
  return file;
}

}  // namespace catena::render
