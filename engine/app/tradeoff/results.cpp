#include "engine/app/tradeoff/results.h"

#include "engine/base/numbers.h"
#include "haptics/extract/extract.h"

namespace catena::app {

Hand::Hand(const std::string& text) : state_(std::make_unique<haptics::ChainState>()), scratch_(std::make_unique<haptics::ChainScratch>()) {
  auto scene = scene::parse_scene(text, "figure");
  CATENA_ASSERT(static_cast<bool>(scene));
  auto program = haptics::extract_program(*scene);
  CATENA_ASSERT(static_cast<bool>(program));
  program_ = *program;
}

std::string to_json(const Vec3& v) { return "[" + to_text(v.x) + ", " + to_text(v.y) + ", " + to_text(v.z) + "]"; }

}  // namespace catena::app
