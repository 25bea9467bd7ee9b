// SPDX-License-Identifier: MIT
// Way of a ray through a paged volume, from entry to entry of its page table.

// Part of a ray in an entry.
struct EntryPart {
  uint word;
  LocalRay ray;       // in voxels of the page, if the entry has one
  float from, to;     // depths
  int entries;        // entries that may be skipped along each axis
};

// Begins at depth `from`; `flipped`: the ray over the cells of the finest level.
CellTraversal begin_traversal(LocalRay ray, FlippedRay flipped, float from) {
  const vec3 begin = clamp(floor(ray.origin + from * ray.direction), frame.grids[0].lo, frame.grids[0].hi - 1.0);
  return CellTraversal(ivec3(begin) ^ flipped.turned, from, bvec3(false));
}

bool is_inside(CellTraversal traversal, FlippedRay flipped, float to) { return traversal.t < to && all(lessThan(traversal.cell, flipped.end)); }

// Returns the part of the ray in the current entry, and counts its visit.
EntryPart enter_entry(LocalRay ray, CellTraversal traversal, FlippedRay flipped, float to) {
  const ivec3 entry = (traversal.cell ^ flipped.turned) >> 6;
  const uint word = texelFetch(page_table, entry, 0).r;
  EntryPart part = EntryPart(word, ray, traversal.t, to, max(1, page_distance(word)));
  if (is_stored(word)) {
    count_visit(entry);
    const PageLevelData data = pages.levels[page_level(word)];
    part.ray.origin = data.scale * ray.origin + data.offset - first_of_page(page_level(word), entry);
    part.ray.direction = data.scale * ray.direction;
    part.to = min(to, max(traversal.t, min_component(exits(flipped, min((traversal.cell | 63) + 1, flipped.end)))));
    part.entries = 1;
  }
  return part;
}

void leave_entry(EntryPart part, inout CellTraversal traversal, FlippedRay flipped) {
  advance_past(traversal, flipped, (traversal.cell | 63) + (64 * part.entries - 63));
}

// Begins the way through the cells of a page.
CellTraversal begin_page(EntryPart part, FlippedRay in_page) {
  const vec3 first = clamp(floor(part.ray.origin + part.from * part.ray.direction), vec3(0.0), vec3(PAGE_EDGE - 1));
  return CellTraversal(ivec3(first) ^ in_page.turned, part.from, bvec3(false));
}
