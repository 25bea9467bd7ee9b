#include "engine/scene/scene_keys.h"

#include "engine/scene/write_values.h"

namespace catena::scene {

Key clip_key() { return schema::boolean("clip", "False: the clip planes leave it whole.").by_default("true"); }
Key visible_key() { return schema::boolean("visible", "False: it is not drawn, but still felt and followed.").by_default("true"); }
Key opacity_key(const std::string& help) { return schema::number("opacity", "", help).within(0, 1); }

Keys color_scale_keys(std::string_view map, const std::string& range) {
  return {schema::any_of("color", {schema::table("", 4, "value", ""), schema::text("", "")},
                         "Rows `[value, r, g, b]`, or the name of a colour map (`catena info --colormaps`).")
              .ranged("values rising")
              .by_default("\"" + std::string(map) + "\""),
          schema::vector("range", 2, "value", "Between which values the named map lies; not beside a table.")
              .ranged("rising")
              .by_default(range),
          schema::file("transfer", "A file that says all of it: Catena's (`assets/transfer/`) or a ParaView colour map.")};
}

Keys transfer_keys() {
  return schema::joined(
      color_scale_keys(kDefaultVolumeMap, "0.5 to 99.8 percentile; with a named map all values"),
      {schema::table("opacity", 2, "value, 1", "Rows `[value, alpha]`, alpha per `opacity_unit`.")
           .ranged("0 <= alpha < 1")
           .by_default("from the values"),
       schema::number("opacity_unit", "world", "The length that alpha is meant for.").positive().by_default("smallest voxel edge"),
       schema::table("extinction", 2, "value, 1/world", "Rows `[value, sigma]`, instead of `opacity`.").ranged("sigma >= 0"),
       schema::table("gradient_opacity", 2, "value/world, 1", "Rows `[slope, factor]`: the slope multiplies the extinction.")
           .ranged("factor 0 to 1")
           .by_default("1 everywhere")});
}

}  // namespace catena::scene
