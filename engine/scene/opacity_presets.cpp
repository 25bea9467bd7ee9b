// SPDX-License-Identifier: MIT
#include "engine/scene/opacity_presets.h"

#include <algorithm>

namespace catena::scene {

namespace {

const std::vector<TransferFunction::ColorPoint> kGreys{{0, {0, 0, 0}}, {1, {1, 1, 1}}};

std::vector<OpacityPreset> make_presets() {
  return {{"ct-bone",
           "bone in computed tomography",
           false,
           false,
           {{100, {0.55f, 0.3f, 0.2f}}, {300, {0.88f, 0.76f, 0.6f}}, {1200, {1, 0.98f, 0.94f}}},
           {{150, 0}, {250, 0.3}, {700, 0.8}}},
          {"ct-soft",
           "skin, muscle and organs in computed tomography",
           false,
           false,
           {{-300, {0.75f, 0.5f, 0.4f}}, {0, {0.85f, 0.55f, 0.45f}}, {80, {0.75f, 0.3f, 0.25f}}, {400, {0.95f, 0.9f, 0.8f}}},
           {{-250, 0}, {-100, 0.05}, {40, 0.25}, {200, 0.5}}},
          {"ct-lung",
           "airways and lung tissue in computed tomography",
           false,
           false,
           {{-1000, {0.1f, 0.15f, 0.3f}}, {-800, {0.35f, 0.5f, 0.7f}}, {-500, {0.9f, 0.75f, 0.65f}}},
           {{-950, 0}, {-850, 0.02}, {-600, 0.15}, {-400, 0}}},
          {"ct-angio",
           "vessels with contrast agent and bone in computed tomography",
           false,
           false,
           {{120, {0.6f, 0.1f, 0.08f}}, {300, {0.9f, 0.3f, 0.2f}}, {600, {0.95f, 0.9f, 0.8f}}},
           {{120, 0}, {180, 0.2}, {400, 0.7}}},
          {"mr", "tissue in magnetic resonance", true, false, kGreys, {{0.2, 0}, {0.4, 0.1}, {1, 0.6}}},
          {"angio", "vessels in an angiogram, as maximum intensity projection", true, true, kGreys, {{0.1, 0}, {0.9, 0.95}}},
          {"micro",
           "dense material in micro-tomography",
           true,
           false,
           {{0.3, {0.35f, 0.3f, 0.25f}}, {0.6, {0.8f, 0.75f, 0.65f}}, {1, {1, 1, 1}}},
           {{0.4, 0}, {0.55, 0.4}, {1, 0.9}}},
          {"em",
           "dark structures in electron microscopy",
           true,
           false,
           {{0, {0.95f, 0.9f, 0.75f}}, {0.5, {0.4f, 0.45f, 0.6f}}},
           {{0, 0.8}, {0.25, 0.3}, {0.45, 0}}},
          {"fluorescence",
           "bright structures on a dark background in fluorescence microscopy",
           true,
           false,
           {{0, {0, 0.1f, 0}}, {0.5, {0.1f, 0.8f, 0.2f}}, {1, {0.9f, 1, 0.8f}}},
           {{0.1, 0}, {0.3, 0.05}, {1, 0.5}}}};
}

}  // namespace

const std::vector<OpacityPreset>& opacity_presets() {
  static const std::vector<OpacityPreset> presets = make_presets();
  return presets;
}

const OpacityPreset* find_opacity_preset(std::string_view name) {
  const auto found = std::ranges::find(opacity_presets(), name, &OpacityPreset::name);
  return found == opacity_presets().end() ? nullptr : &*found;
}

std::vector<std::string_view> opacity_preset_names() {
  std::vector<std::string_view> names;
  for (const OpacityPreset& preset : opacity_presets()) names.push_back(preset.name);
  return names;
}

OpacityPreset scaled_to(OpacityPreset preset, double lo, double hi) {
  if (!preset.is_relative) return preset;
  const auto scaled = [&](double t) { return (1 - t) * lo + t * hi; };
  for (auto& point : preset.colors) point.value = scaled(point.value);
  for (auto& point : preset.opacities) point.value = scaled(point.value);
  preset.is_relative = false;
  return preset;
}

}  // namespace catena::scene
