// SPDX-License-Identifier: MIT
#include "engine/app/viewer/input/plane_views.h"

#include <algorithm>
#include <cmath>

#include "engine/field/field_display_range.h"
#include "engine/field/grid/grid.h"
#include "render/frame/grid_cells.h"

namespace catena::app {

namespace {

/// Distance of neighboring voxels along a direction.
double voxel_step(const field::ScalarGrid& grid, const Vec3& direction) {
  double step = 0;
  for (int i = 0; i < 3; ++i) step = std::max(step, std::fabs(dot(grid.mapping().world_from_index_linear[i], direction)));
  return step;
}

void change_window(OrthoViews& views, const render::SliceItem& slice, const Input& input, const Area& area) {
  const DisplayRange& range = field::display_range(*slice.grid);
  const double whole = range.lo < range.hi ? range.hi - range.lo : 1;
  const auto [lo, hi] = views.window.value_or(std::array{range.lo, range.lo + whole});
  const double width = std::max(1e-3 * whole, hi - lo + 2 * whole * input.dx / area.width);
  const double level = 0.5 * (lo + hi) + whole * input.dy / area.height;
  views.window = {level - 0.5 * width, level + 0.5 * width};
}

}  // namespace

Area page_view_area(const Area& page, int view) {
  const int cell = render::grid_cell(view);
  const double width = 0.5 * page.width, height = 0.5 * page.height;
  return {page.x + cell % 2 * width, page.y + cell / 2 * height, width, height};
}

int page_view_at(const Area& page, double x, double y) {
  return render::grid_cell((x >= page.x + 0.5 * page.width ? 1 : 0) + (y >= page.y + 0.5 * page.height ? 2 : 0));
}

Vec3 plane_point(const render::FramePacket& plane, const Area& area, double x, double y) {
  render::Camera camera = make_area_camera(plane.view, area.width, area.height);
  camera.stretch = Vec3(1.0);  // the slice is in display units
  const render::Ray ray = render::pixel_ray(camera, x - area.x, y - area.y);
  const render::SliceItem& slice = plane.slices.front();
  const double distance = dot(slice.point - ray.origin, slice.normal) / dot(ray.direction, slice.normal);
  return (ray.origin + distance * ray.direction) / plane.view.stretch;
}

namespace {

constexpr double kPlaneZoomPerNotch = 1.15;

/// Point at the middle of the images, world units.
Vec3 shown_center(const OrthoViews& views, const render::FramePacket& plane) {
  const field::ScalarGrid& grid = *plane.slices.front().grid;
  const field::Box box = grid.index_box();
  return views.center.value_or(grid.mapping().world_from_index(0.5 * box.lo + 0.5 * box.hi) / plane.view.stretch);
}

/// Magnifies about the point under the pointer, which stays where it is.
void zoom_planes(OrthoViews& views, const render::FramePacket& plane, const Vec3& at, double notches) {
  const double before = views.zoom;
  views.zoom = std::clamp(before * std::pow(kPlaneZoomPerNotch, notches), scene::kMinPlaneZoom, scene::kMaxPlaneZoom);
  const Vec3 in_plane = at - plane.view.target / plane.view.stretch;
  views.center = shown_center(views, plane) + (1 - before / views.zoom) * in_plane;
}

}  // namespace

NavigationChanges apply_to_plane(Navigation& controls, const Input& input, const render::FramePacket& plane, const Area& area) {
  NavigationChanges changed;
  const render::SliceItem& slice = plane.slices.front();
  const Vec3 at = plane_point(plane, area, input.x + input.dx, input.y + input.dy);
  const bool moved = input.dx != 0 || input.dy != 0;
  const std::uint32_t buttons = input.space || (controls.probe_mode && input.left) ? 1u : 0u;
  changed.probe = buttons != controls.buttons;
  controls.buttons = buttons;
  if (input.middle || (input.left && input.shift)) {
    const Vec3 from = plane_point(plane, area, input.x, input.y);
    if (moved) controls.ortho.center = shown_center(controls.ortho, plane) + (from - at);
    changed.view = moved;
  } else if (controls.probe_mode && moved) {
    controls.probe = at;
    changed.probe = true;
  } else if (input.left && !controls.probe_mode) {
    controls.ortho.focus = at;
    changed.view = true;
  } else if (input.right && moved) {
    change_window(controls.ortho, slice, input, area);
    changed.view = true;
  }
  if (input.wheel != 0 && input.control) {
    zoom_planes(controls.ortho, plane, at, input.wheel);
    changed.view = true;
  } else if (input.wheel != 0) {
    const Vec3 step = input.wheel * voxel_step(*slice.grid, slice.normal) * slice.normal / plane.view.stretch;
    controls.ortho.focus = slice.point / plane.view.stretch + step;
    if (controls.probe_mode) controls.probe += step, changed.probe = true;
    changed.view = true;
  }
  return changed;
}

}  // namespace catena::app
