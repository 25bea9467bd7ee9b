// SPDX-License-Identifier: MIT
#include "render/passes/paged_surfaces.h"

#include <algorithm>
#include <set>

namespace catena::render {
namespace {

constexpr std::uint32_t kPagedSurfaceVertexShader[] = {
#include "spirv/fullscreen.vert.inc"
};
constexpr std::uint32_t kPagedSurfaceFragmentShader[] = {
#include "spirv/isosurface_paged.frag.inc"
};

/// Returns the level as a number, between those of the voxels.
double level_number(const CodeScale& codes, double level) { return codes.per_code > 0 ? (level - codes.lo) / codes.per_code : 0; }

/// Returns which ranges contain none of the levels: those whose ends have the same number of levels below them.
CodeAppearance level_appearance(const CodeScale& codes, const std::vector<double>& levels) {
  CodeAppearance appearance;
  appearance.is_invisible.fill(true);
  for (std::size_t code = 0; code < appearance.appearance_id.size(); ++code)
    appearance.appearance_id[code] =
        std::uint16_t(std::ranges::count_if(levels, [&](double level) { return level_number(codes, level) < codes.lower_end(int(code)); }));
  return appearance;
}

bool has_volume_in_pages(const FramePacket& packet) { return !packet.volumes.empty() && packet.volumes.front().paged != nullptr; }

}  // namespace

Outcome PagedSurfaces::add_pool(Frame& frame, const std::shared_ptr<const field::PagedGrid>& grid, std::size_t sharers) {
  std::uint64_t most = page_pool_bytes(frame.device, frame.residency.available_bytes(), sharers);
  if (frame.settings.fast) most = std::min(most, frame.settings.fast->max_bytes);
  CATENA_TRY(PagedVolume pages, PagedVolume::create(frame.device, {grid}, PageFormat::numbers, most));
  pools_.insert_or_assign(grid.get(), Pool{grid, std::move(pages), {}});
  return Done{};
}

Outcome PagedSurfaces::prepare(Frame& frame, const std::vector<const IsosurfaceItem*>& items) {
  std::map<const field::PagedGrid*, std::set<double>> levels;
  for (const IsosurfaceItem* item : items) levels[item->paged.get()].insert(item->level);
  warning_.clear();
  version_ += std::erase_if(pools_, [&](const auto& pool) { return !levels.contains(pool.first); });
  std::size_t sharers = levels.size() - pools_.size() + (has_volume_in_pages(frame.packet) ? 1 : 0);
  for (const IsosurfaceItem* item : items) {
    if (!levels.contains(item->paged.get()) || pools_.contains(item->paged.get())) continue;
    if (Outcome added = add_pool(frame, item->paged, sharers); !added) {
      if (frame.device.is_lost()) return added;
      warning_ = "isosurfaces of \"" + item->grid->name() + "\" are drawn from a coarser level: " + added.error().message;
      levels.erase(item->paged.get());
    }
    --sharers;
  }
  std::uint64_t pages_version = 0;
  for (auto& [grid, pool] : pools_) {
    const std::vector<double> next(levels[grid].begin(), levels[grid].end());
    if (pool.levels != next) {
      const CodeScale codes = number_scale(*grid, {next.front(), next.back()});
      CATENA_CHECK(pool.pages.set_codes({codes}, {level_appearance(codes, next)}));
      pool.levels = next;
    }
    if (!frame.settings.waits_for_pages) CATENA_CHECK(pool.pages.update());
    pages_version += pool.pages.version();
  }
  if (std::exchange(pages_version_, pages_version) != pages_version) ++version_;
  return Done{};
}

std::vector<PagedVolume*> PagedSurfaces::pages() {
  std::vector<PagedVolume*> list;
  for (auto& [grid, pool] : pools_) list.push_back(&pool.pages);
  return list;
}

shared::GridData PagedSurfaces::grid_data(const CameraRays& rays, const IsosurfaceItem& item) const {
  const Pool& pool = pools_.at(item.paged.get());
  shared::GridData data = rays.grid_data(pool.pages.local_geometry(), pool.grid->mapping());
  data.level = float(level_number(pool.pages.codes().front(), item.level));
  data.color = {item.color.r, item.color.g, item.color.b};
  data.id = item.id;
  data.is_clipped = item.is_clipped;
  return data;
}

Result<const vk::Pipeline*> PagedSurfaces::pipeline(vk::Device& device, bool is_masked) {
  vk::Pipeline& pipeline = pipelines_[is_masked];
  if (!pipeline) {
    vk::GraphicsInfo info;
    info.vertex = kPagedSurfaceVertexShader;
    info.fragment = kPagedSurfaceFragmentShader;
    info.layout_bindings = {{0, vk::DescriptorKind::uniform},
                            {3, vk::DescriptorKind::texture},
                            {5, vk::DescriptorKind::texture},
                            {vk::kSharedBinding, vk::DescriptorKind::sampled}};
    add_page_layout(info.layout_bindings);
    info.constants.resize(7);
    info.constants[6] = is_masked;
    info.colors = opaque_formats();
    info.has_depth = true;
    CATENA_TRY(pipeline, vk::Pipeline::create(device, info));
  }
  return &pipeline;
}

Outcome PagedSurfaces::draw(vk::Commands& commands, Frame& frame, const IsosurfaceItem& item, const vk::Buffer& uniform) {
  PagedVolume& pages = pools_.at(item.paged.get()).pages;
  pages.begin_image(frame.rays, false);
  CATENA_TRY(const vk::Pipeline* pipe, pipeline(frame.device, pages.is_masked()));
  std::vector<vk::Binding> bindings{{0, vk::DescriptorKind::uniform, &uniform, nullptr, nullptr},
                                    {3, vk::DescriptorKind::texture, nullptr, &pages.words(), nullptr},
                                    {5, vk::DescriptorKind::texture, nullptr, &pages.map(), nullptr}};
  pages.add_bindings(bindings);
  commands.bind(*pipe, bindings);
  commands.draw_triangle();
  return Done{};
}

void PagedSurfaces::finish_visits(vk::Commands& commands) {
  for (auto& [grid, pool] : pools_) pool.pages.finish_visits(commands);
}

}  // namespace catena::render
