// SPDX-License-Identifier: MIT
#include "haptics/constraints/registry.h"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <system_error>

#include "haptics/constraints/common/link_schema.h"
#include "haptics/constraints/common/snap.h"
#include "haptics/constraints/forces/forces.h"
#include "haptics/constraints/friction/friction.h"
#include "haptics/constraints/isosurface/isosurface.h"
#include "haptics/constraints/mesh/mesh.h"
#include "haptics/constraints/presets/mode_presets.h"
#include "haptics/constraints/shapes/shapes.h"
#include "haptics/constraints/streamline/streamline.h"

namespace catena::haptics {
namespace {

std::string known_types() {
  std::string list;
  for (const ConstraintType& type : constraint_types()) list += (list.empty() ? "" : ", ") + type.type;
  for (const ModePreset& mode : mode_presets()) list += ", " + mode.type;
  return list;
}

std::vector<ConstraintType>& list_of_types() {
  static std::vector<ConstraintType> list{
      point_constraint(),               //
      line_constraint(),                //
      segment_constraint(),             //
      polyline_constraint(),            //
      curves_constraint(),              //
      points_constraint(),              //
      plane_constraint(),               //
      sphere_constraint(),              //
      box_constraint(),                 //
      mesh_constraint(),                //
      isosurface_constraint(),          //
      streamline_constraint(),          //
      drag_constraint(),                //
      friction_constraint(),            //
      modulated_friction_constraint(),  //
      texture_constraint(),             //
      viscosity_constraint(),           //
      gradient_force_constraint(),      //
      vortex_core_constraint(),         //
      pathline_constraint(),            //
  };
  return list;
}

/// Returns the help text of a constraint for the user, with its source in the paper and its plug-in.
std::string described(const ConstraintType& type) {
  return type.help + (type.paper.empty() ? "" : " Paper: " + type.paper + ".") +
         (type.plugin.empty() ? "" : " From the plug-in " + type.plugin + ".");
}

/// Builds a constraint of a plug-in. Exceptions and null results become errors of the link.
Result<std::shared_ptr<const Constraint>> build_of_plugin(const ConstraintType& type, const json::Node& link, const BuildContext& context) {
  const auto failed = [&](const std::string& why) {
    return json::error_at(link, fmt::format("the plug-in {} {}; a constraint of type \"{}\" was expected", type.plugin, why, type.type));
  };
  try {
    auto built = type.build(link, context);
    if (built && *built == nullptr) return failed("built nothing");
    return built;
  } catch (const std::bad_alloc&) {
    throw;  // system errors are not the plug-in's and are passed on
  } catch (const std::system_error&) {
    throw;
  } catch (const std::exception& error) {
    return failed(fmt::format("threw an exception ({})", error.what()));
  } catch (...) {
    return failed("threw an exception");
  }
}

}  // namespace

const std::vector<ConstraintType>& constraint_types() { return list_of_types(); }

void register_constraint(ConstraintType type) { list_of_types().push_back(std::move(type)); }

const ConstraintType* find_constraint_type(std::string_view type) {
  for (const ConstraintType& entry : constraint_types())
    if (entry.type == type) return &entry;
  return nullptr;
}

const schema::Keys& common_keys() {
  static const schema::Keys keys{
      schema::identifier("name", "Unique name of the link, used in the column names of the tick CSV.").required(),
      schema::text("type", "Type of the link.").required(),
      schema::number("stiffness", "N/m", "Stiffness of the link's spring.").non_negative().or_field().with_default("`coupling.stiffness`"),
      schema::number("snap", "world",
                     "Distance between probe and feature within which the link engages; with `snap` the link starts released.")
          .positive()
          .or_field(),
      schema::number("release", "world", "Distance between probe and proxy at which the link releases.")
          .positive()
          .or_field()
          .with_initial_value("0.05 L")
          .with_default("2 `snap`; without `snap` never"),
      switch_key(),
      schema::boolean("enabled", "`false`: the link is off, regardless of `active_when`.").with_default("true"),
      release_cue_key(),
      align_key()};
  return keys;
}

schema::Section chain_component() {
  schema::Section chain{"chain", "Links of the haptic chain, in order.", schema::Section::Layout::list, common_keys(), kMaxSceneLinks};
  for (const ConstraintType& type : constraint_types()) chain.variants.push_back({type.type, described(type), type.keys});
  for (const ModePreset& mode : mode_presets()) chain.variants.push_back({mode.type, mode.help + " Paper: " + mode.paper + ".", mode.keys});
  return chain;
}

schema::Key scalar_field_key(const std::string& name) {
  return schema::reference(name, schema::Role::scalar_field, "Name of a scalar field.");
}
schema::Key vector_field_key(const std::string& name) {
  return schema::reference(name, schema::Role::vector_field, "Name of a vector field.");
}
schema::Key level_key(const std::string& help) {
  return schema::number("level", "value", help).with_range_text("in the field's range").with_role(schema::Role::level).or_widget();
}
schema::Key length_key(const std::string& name, const std::string& help) {
  return schema::number(name, "world", help).non_negative().or_field();
}
schema::Key free_key(const std::string& above) {
  return schema::choice("free", {"none", "above", "below"}, "Side of the surface on which the probe moves freely; `above`: " + above + ".")
      .with_default("\"none\"");
}
schema::Key law_key(const std::string& help) { return schema::choice("law", {"robust", "as_published"}, help).with_default("\"robust\""); }

Result<std::shared_ptr<const Constraint>> build_constraint(const json::Node& link, const BuildContext& context) {
  CATENA_CHECK(json::expect_object(link, "a link of the chain"));
  CATENA_TRY(const std::string word, json::require_string(link, "type"));
  const ConstraintType* type = find_constraint_type(word);
  if (!type)
    return json::error_at(*link.find("type"),
                          fmt::format("unknown constraint type \"{}\"; expected one of {}, or a type of a --plugin", word, known_types()));
  CATENA_CHECK(json::check_known_keys(link, schema::key_names(common_keys(), type->keys)));
  CATENA_TRY(std::shared_ptr<const Constraint> made,
             type->plugin.empty() ? type->build(link, context) : build_of_plugin(*type, link, context));
  return wrap_snap(link, type->has_own_release, std::move(made), context);
}

}  // namespace catena::haptics
