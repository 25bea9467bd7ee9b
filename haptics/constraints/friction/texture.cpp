// SPDX-License-Identifier: MIT
#include "haptics/constraints/friction/friction.h"

#include <fmt/format.h>

#include "haptics/constraints/common/link_schema.h"
#include "haptics/constraints/friction/friction_contact.h"

namespace catena::haptics {
namespace {

/// Returns a triangle wave: -1 at integer t, 1 halfway between integers.
double triangle(double t) {
  const double part = t - std::floor(t);
  return std::isfinite(part) ? 1 - 4 * std::fabs(part - 0.5) : 0;
}

class Texture final : public ContactDrag {
 public:
  Texture(Parameter threshold, double amplitude, double wavelength, ContactSpec contact)
      : ContactDrag(std::move(contact)), threshold_(std::move(threshold)), amplitude_(amplitude), wavelength_(wavelength) {}

 private:
  double threshold(const Vec3& p, LinkState& state, LinkScratch& scratch) const noexcept override {
    const double wave = (triangle(p.x / wavelength_) + triangle(p.y / wavelength_) + triangle(p.z / wavelength_)) / 3;
    return threshold_.at(p, scratch.parameter_cursor, state.evaluations) * (1 + amplitude_ * wave);
  }
  Parameter threshold_;
  double amplitude_, wavelength_;
};

Result<std::shared_ptr<const Constraint>> build_texture(const json::Node& link, const BuildContext& context) {
  CATENA_TRY(Parameter threshold, require_parameter(link, "threshold", json::NumberRange::non_negative, context));
  CATENA_TRY(const double amplitude, json::get_number(link, "amplitude", 0.5, json::NumberRange::non_negative));
  if (amplitude > 1)
    return json::error_at(*link.find("amplitude"), fmt::format("\"amplitude\" is {}; a number from 0 to 1 was expected", amplitude));
  CATENA_TRY(const double wavelength, json::require_number(link, "wavelength", json::NumberRange::positive));
  CATENA_TRY(ContactSpec contact, read_contact(link, SurfaceRequirement::optional_with_level, context));
  return std::shared_ptr<const Constraint>(std::make_shared<Texture>(std::move(threshold), amplitude, wavelength, std::move(contact)));
}

}  // namespace

ConstraintType texture_constraint() {
  return {
      "texture",
      "Drag whose threshold varies periodically in space.",
      "section 3",
      {length_key("threshold", "Mean distance between probe and proxy at which the proxy slips.").with_initial_value("0.005 L").required(),
       schema::number("amplitude", "", "Amplitude of the variation, as a fraction of `threshold`.").within(0, 1).with_default("0.5"),
       schema::number("wavelength", "world", "Wavelength of the variation.").positive().required(), surface_key(), surface_level_key()},
      build_texture};
}

}  // namespace catena::haptics
