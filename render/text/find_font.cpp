#include <fontconfig/fontconfig.h>

#include "render/text/font.h"

namespace catena::render {

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
