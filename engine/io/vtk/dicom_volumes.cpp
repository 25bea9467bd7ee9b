// SPDX-License-Identifier: MIT
#include "engine/io/vtk/dicom_volumes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <tuple>

#include "engine/base/numbers.h"
#include "engine/base/text.h"

namespace catena::vtk {
namespace {

using Frames = std::vector<const DicomFrame*>;

constexpr double kSameDirection = 1e-3;  // difference of unit vectors
constexpr double kSameSpacing = 1e-3;    // relative

/// Returns the distance along the normal, mm, below which frames have the same position: small relative to a pixel, even in microscopy.
double position_tolerance(const DicomFrame& frame) {
  constexpr double kMaxToleranceMm = 1e-3, kPart = 0.02;
  const double pixel = std::min(frame.column_spacing, frame.row_spacing);
  return pixel > 0 ? std::min(kMaxToleranceMm, kPart * pixel) : kMaxToleranceMm;
}
bool same_axes(const DicomFrame& a, const DicomFrame& b) {
  return norm(a.row_direction - b.row_direction) < kSameDirection && norm(a.column_direction - b.column_direction) < kSameDirection;
}
bool same_size(const DicomFrame& a, const DicomFrame& b) { return a.columns == b.columns && a.rows == b.rows; }
bool same_spacing(const DicomFrame& a, const DicomFrame& b) {
  const auto same = [](double p, double q) { return std::fabs(p - q) <= kSameSpacing * std::max(p, q); };
  return same(a.column_spacing, b.column_spacing) && same(a.row_spacing, b.row_spacing);
}

std::string orientation_word(const DicomFrame& frame) {
  const Vec3 n = frame.normal();
  constexpr double kNear = 0.9;
  for (const auto& [axis, word] : {std::pair{0, "sagittal"}, {1, "coronal"}, {2, "axial"}})
    if (std::fabs(n[axis]) > kNear) return word;
  return "oblique";
}

/// Sorts frames along the normal; frames at the same position by their numbers.
void sort_along_normal(Frames& frames) {
  const Vec3 normal = frames.front()->normal();
  const auto position_of = [&](const DicomFrame* frame) { return dot(frame->position, normal); };
  std::ranges::sort(frames, [&](const DicomFrame* a, const DicomFrame* b) {
    return std::make_tuple(position_of(a), a->instance, a->file, a->index) <
           std::make_tuple(position_of(b), b->instance, b->file, b->index);
  });
  for (auto from = frames.begin(); from != frames.end();) {
    const auto to = std::find_if(
        from, frames.end(), [&](const DicomFrame* frame) { return position_of(frame) - position_of(*from) > position_tolerance(*frame); });
    std::sort(from, to, [](const DicomFrame* a, const DicomFrame* b) {
      return std::make_tuple(a->instance, a->file, a->index) < std::make_tuple(b->instance, b->file, b->index);
    });
    from = to;
  }
}

/// Returns the numbers of consecutive sorted frames at the same position.
std::vector<std::size_t> counts_at_places(const Frames& sorted) {
  std::vector<std::size_t> counts;
  const Vec3 normal = sorted.front()->normal();
  double at = 0;
  for (const DicomFrame* frame : sorted) {
    const double position = dot(frame->position, normal);
    if (counts.empty() || position - at > position_tolerance(*frame)) {
      counts.push_back(1);
      at = position;
    } else {
      ++counts.back();
    }
  }
  return counts;
}

/// Returns the maximum distance of the frames, across the normal, from the line through the first and the last.
double distance_from_line(const Frames& sorted) {
  const Vec3 normal = sorted.front()->normal(), from = sorted.front()->position, all = sorted.back()->position - from;
  const double span = dot(all, normal);
  double maximum = 0;
  for (const DicomFrame* frame : sorted) {
    const Vec3 d = frame->position - from;
    maximum = std::max(maximum, norm(d - (span > position_tolerance(*sorted.front()) ? dot(d, normal) / span : 0.0) * all));
  }
  return maximum;
}

bool is_stack(const Frames& sorted) {
  const std::vector<std::size_t> counts = counts_at_places(sorted);
  const double pixel = std::min(sorted.front()->column_spacing, sorted.front()->row_spacing);
  return std::ranges::all_of(counts, [](std::size_t n) { return n == 1; }) &&
         (sorted.size() < 3 || distance_from_line(sorted) <= 0.5 * std::max(pixel, position_tolerance(*sorted.front())));
}

struct Part {
  std::string suffix;
  Frames frames;
  bool told_apart = true;  ///< false: separated only by their numbers
};

std::vector<Part> parted_by(const Frames& frames, DicomKey key, const DicomFile& file) {
  std::vector<Part> parts;
  std::map<std::string, std::size_t> known;
  for (const DicomFrame* frame : frames) {
    const std::string& value = frame->keys[static_cast<std::size_t>(key)];
    const auto [at, is_new] = known.emplace(value, parts.size());
    if (is_new) {
      const DicomKeyInfo info = key_info(key);
      std::string suffix = value.empty() ? fmt::format("no {}", info.name)
                                         : fmt::format("{} {}{}", info.name, sanitize_for_terminal(value.substr(0, 64)), info.unit);
      const auto number = static_cast<std::size_t>(std::max(0, std::atoi(value.c_str())));
      if (key == DicomKey::segment && number < file.segments.size() && !file.segments[number].empty())
        suffix += fmt::format(" ({})", file.segments[number]);
      parts.push_back({std::move(suffix), {}});
    }
    parts[at->second].frames.push_back(frame);
  }
  std::ranges::stable_sort(parts, [&](const Part& a, const Part& b) {
    const auto& x = a.frames.front()->keys[static_cast<std::size_t>(key)];
    const auto& y = b.frames.front()->keys[static_cast<std::size_t>(key)];
    const double p = std::atof(x.c_str()), q = std::atof(y.c_str());
    return p != q ? p < q : x < y;
  });
  for (Part& part : parts) sort_along_normal(part.frames);
  return parts;
}

/// Separates frames that no header distinguishes: the first at each position, the second, and so on.
std::vector<Part> parted_by_number(const Frames& sorted) {
  std::vector<Part> parts;
  std::size_t at = 0;
  for (const std::size_t count : counts_at_places(sorted)) {
    for (std::size_t n = 0; n < count; ++n) {
      if (parts.size() <= n) parts.push_back({fmt::format("volume {}", n + 1), {}, false});
      parts[n].frames.push_back(sorted[at + n]);
    }
    at += count;
  }
  return parts;
}

/// Returns whether the distances between slices along the normal are equal.
bool is_even(const Frames& sorted) {
  constexpr double kUneven = 0.02;
  const Vec3 normal = sorted.front()->normal();
  const double step = dot(sorted.back()->position - sorted.front()->position, normal) / std::max(1.0, double(sorted.size()) - 1);
  for (std::size_t k = 1; k < sorted.size(); ++k)
    if (std::fabs(dot(sorted[k]->position - sorted[k - 1]->position, normal) - step) > kUneven * std::fabs(step)) return false;
  return true;
}

/// Returns the acquisitions of a stack if slices of one lie between those of another; empty if they do not.
std::vector<Part> interleaved_acquisitions(const Frames& stack, const DicomFile& file) {
  std::vector<Part> parts = parted_by(stack, DicomKey::acquisition, file);
  const Vec3 normal = stack.front()->normal();
  const auto from = [&](const Part& part) { return dot(part.frames.front()->position, normal); };
  const auto to = [&](const Part& part) { return dot(part.frames.back()->position, normal); };
  for (std::size_t a = 0; a < parts.size(); ++a)
    for (std::size_t b = a + 1; b < parts.size(); ++b)
      if (parts[a].frames.size() > 1 && parts[b].frames.size() > 1 && from(parts[a]) < to(parts[b]) && from(parts[b]) < to(parts[a]))
        return parts;
  return {};
}

/// Separates frames into stacks with one frame per position: by the key that needs the fewest stacks; if no key suffices, by the one that
/// comes nearest, and recursively.
std::vector<Part> stacks_of(Frames frames, const DicomFile& file, int depth = 0) {
  sort_along_normal(frames);
  const bool has_positions = std::ranges::all_of(frames, [](const DicomFrame* frame) { return frame->has_position; });
  if (!has_positions || !file.problem.empty()) return {{{}, std::move(frames)}};  // one volume, rejected later
  const bool segments = file.segmentation && depth == 0;
  if (is_stack(frames) && !segments) {
    // two passes that interleave evenly are one scan; two passes that are evenly spaced only by themselves are two scans
    std::vector<Part> passes = is_even(frames) ? std::vector<Part>() : interleaved_acquisitions(frames, file);
    if (!passes.empty() && std::ranges::all_of(passes, [](const Part& part) { return is_even(part.frames); })) return passes;
    return {{{}, std::move(frames)}};
  }
  const std::size_t deepest = std::ranges::max(counts_at_places(frames));
  std::vector<Part> best;
  bool best_done = false;
  for (std::size_t k = 0; k < static_cast<std::size_t>(DicomKey::count); ++k) {
    const auto key = static_cast<DicomKey>(k);
    if (segments && key != DicomKey::segment) break;
    std::vector<Part> parts = parted_by(frames, key, file);
    if (parts.size() < 2 && !segments) continue;
    const bool done = std::ranges::all_of(parts, [](const Part& part) { return is_stack(part.frames); });
    if (done ? (!best_done || parts.size() < best.size()) : (!best_done && best.empty() && parts.size() <= deepest)) {
      best = std::move(parts);
      best_done = done;
    }
  }
  constexpr int kDeepest = 4;
  // a key that differs in every image does not separate stacks
  const bool too_many = best.size() > 2 * std::max<std::size_t>(deepest, 2) && !segments;
  if (best.empty() || too_many || depth >= kDeepest) {
    const bool has_duplicates = deepest > 1;
    return has_duplicates ? parted_by_number(frames) : std::vector<Part>{{{}, std::move(frames)}};
  }
  std::vector<Part> all;
  for (Part& part : best)
    for (Part& inner : stacks_of(std::move(part.frames), file, depth + 1)) {
      if (!part.suffix.empty() && !inner.suffix.empty()) inner.suffix = ", " + inner.suffix;
      all.push_back({part.suffix + inner.suffix, std::move(inner.frames), inner.told_apart});
    }
  return all;
}

/// Groups frames of the same size, orientation and pixel spacing.
std::vector<Frames> parted_by_geometry(const Frames& frames, const std::vector<DicomFile>& files) {
  std::vector<Frames> parts;
  for (const DicomFrame* frame : frames) {
    const auto fits = [&](const Frames& part) {
      const DicomFrame& other = *part.front();
      const DicomFile &a = files[frame->file], &b = files[other.file];
      return same_size(*frame, other) && same_axes(*frame, other) && same_spacing(*frame, other) && a.localizer == b.localizer &&
             a.frame_of_reference == b.frame_of_reference && a.problem.empty() == b.problem.empty() && a.unit == b.unit;
    };
    const auto part = std::ranges::find_if(parts, fits);
    if (part != parts.end())
      part->push_back(frame);
    else
      parts.push_back({frame});
  }
  std::ranges::stable_sort(parts, [](const Frames& a, const Frames& b) { return a.size() > b.size(); });
  return parts;
}

std::string geometry_suffix(const DicomFrame& one, const DicomFrame& main, const std::vector<DicomFile>& files) {
  if (files[one.file].localizer && !files[main.file].localizer) return "localizer";
  if (!same_axes(one, main)) return orientation_word(one);
  if (!same_size(one, main)) return fmt::format("{} x {} pixels", one.columns, one.rows);
  if (!same_spacing(one, main)) return fmt::format("pixels of {:g} x {:g} mm", one.column_spacing, one.row_spacing);
  return "other images";
}

/// Returns a problem if frames with other pixels lie in the gaps of a stack: they belong to it, and without them it would be wrong; empty
/// if none do.
std::string gap_problem(const Frames& stack, const Frames& others, const std::vector<DicomFile>& files) {
  Frames sorted = stack;
  sort_along_normal(sorted);
  if (sorted.size() < 2 || !same_axes(*sorted.front(), *others.front())) return {};
  const Vec3 normal = sorted.front()->normal();
  std::vector<double> gaps;
  for (std::size_t k = 1; k < sorted.size(); ++k) gaps.push_back(dot(sorted[k]->position - sorted[k - 1]->position, normal));
  std::vector<double> ordered = gaps;
  std::ranges::nth_element(ordered, ordered.begin() + static_cast<std::ptrdiff_t>(ordered.size() / 4));
  const double typical_gap = ordered[ordered.size() / 4];
  for (const DicomFrame* other : others) {
    const double position = dot(other->position, normal);
    for (std::size_t k = 0; k < gaps.size(); ++k) {
      const double from = dot(sorted[k]->position, normal);
      const bool isolated =
          position - from > 0.5 * typical_gap && from + gaps[k] - position > 0.5 * typical_gap && gaps[k] > 1.5 * typical_gap;
      if (!isolated) continue;
      const DicomFrame& main = *sorted.front();
      const std::string name = files[other->file].name;
      if (!same_size(*other, main))
        return fmt::format("{} has {} x {} pixels, expected {} x {} like the other slices", name, other->columns, other->rows, main.columns,
                           main.rows);
      if (!same_spacing(*other, main))
        return fmt::format("{} has pixels of {:g} x {:g} mm, expected {:g} x {:g} like the other slices", name, other->column_spacing,
                           other->row_spacing, main.column_spacing, main.row_spacing);
    }
  }
  return {};
}

/// Sets the problem that makes a stack of frames unusable as a field, and the notes about it.
void check_volume(DicomVolume& volume, const std::vector<DicomFile>& files) {
  const DicomFrame& first = *volume.frames.front();
  std::set<std::string> notes;
  for (const DicomFrame* frame : volume.frames) {
    const DicomFile& file = files[frame->file];
    if (!file.problem.empty()) volume.is_image = false;
    if (!file.problem.empty() && volume.problem.empty()) volume.problem = files.size() > 1 ? file.name + ": " + file.problem : file.problem;
    for (const std::string& note : file.notes)
      if (notes.insert(note).second) volume.notes.push_back(note);
  }
  if (!volume.problem.empty()) return;
  const bool one = volume.frames.size() == 1;
  const auto lacks = [&](const auto& has) { return !std::ranges::all_of(volume.frames, has); };
  if (lacks([](const DicomFrame* f) { return f->has_position; })) {
    if (!one)
      volume.problem = fmt::format("the {} images have no ImagePositionPatient, expected a position for each slice", volume.frames.size());
    else
      volume.notes.push_back("the header has no ImagePositionPatient: the image begins at the origin");
  } else if (lacks([](const DicomFrame* f) { return f->has_orientation; })) {
    volume.notes.push_back("the header has no ImageOrientationPatient: rows are assumed along x and columns along y");
  }
  if (first.column_spacing == 0) {
    if (!one)
      volume.problem = "the headers have no PixelSpacing, expected positive lengths";
    else
      volume.notes.push_back("the header has no PixelSpacing: lengths are in pixels");
  }
  if (one || !volume.problem.empty()) return;
  if (const std::size_t passes = interleaved_acquisitions(volume.frames, files[first.file]).size(); passes > 0)
    volume.notes.push_back(
        fmt::format("the slices come from {} interleaved acquisitions (AcquisitionNumber), which are read as one scan", passes));
  const double off = distance_from_line(volume.frames), pixel = std::min(first.column_spacing, first.row_spacing);
  if (volume.frames.size() > 2 && off > 0.5 * pixel)
    volume.problem = fmt::format("the slices are shifted sideways by up to {:.3g} mm, expected a straight stack", off);
}

struct Series {
  std::string description, number;
  Frames frames;
};

/// Returns SeriesNumber as an integer without sign, leading zeros and blanks; any other text unchanged.
std::string plain_number(const std::string& number) {
  const auto value = parse_integer(number.starts_with('+') ? number.substr(1) : number);
  return value ? std::to_string(*value) : sanitize_for_terminal(number);
}

/// Returns the series in the order of their numbers. If no series has a number, they are counted from 1.
std::vector<Series> series_of(const std::vector<DicomFile>& files) {
  std::vector<Series> all;
  std::map<std::string, std::size_t> known;
  for (const DicomFile& file : files) {
    const auto [at, is_new] = known.emplace(file.series, all.size());
    if (is_new) all.push_back({file.description.empty() ? "series" : file.description, plain_number(file.series_number), {}});
    for (const DicomFrame& frame : file.frames) all[at->second].frames.push_back(&frame);
  }
  const auto number = [](const Series& series) { return std::atof(series.number.c_str()); };
  std::ranges::stable_sort(all, [&](const Series& a, const Series& b) { return number(a) < number(b); });
  if (std::ranges::all_of(all, [](const Series& series) { return series.number.empty(); }))
    for (std::size_t n = 0; n < all.size(); ++n) all[n].number = std::to_string(n + 1);
  return all;
}

/// Names each volume: "7" if it is the only one with this SeriesNumber and no series is named so; otherwise "7.1", "7.2", ..., counted over
/// all series that share the number. A series without a number is found by its name.
void number_volumes(std::vector<DicomVolume>& volumes) {
  std::map<std::string, std::size_t> all, counted;
  for (const DicomVolume& volume : volumes) ++all[volume.series_number];
  for (DicomVolume& volume : volumes) {
    const std::string& number = volume.series_number;
    if (number.empty()) continue;
    const bool is_name = std::ranges::any_of(volumes, [&](const DicomVolume& other) {
      return other.series_index != volume.series_index && (other.name == number || other.series == number);
    });
    volume.volume_number = all[number] == 1 && !is_name ? number : fmt::format("{}.{}", number, ++counted[number]);
  }
}

}  // namespace

std::vector<DicomVolume> group_dicom_volumes(const std::vector<DicomFile>& files) {
  std::vector<DicomVolume> volumes;
  std::size_t series_index = 0;
  for (const Series& series : series_of(files)) {
    std::vector<DicomVolume> series_volumes;
    const std::vector<Frames> parts = parted_by_geometry(series.frames, files);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      std::vector<Part> stacks = stacks_of(parts[p], files[parts[p].front()->file]);
      std::string split_problem;
      for (std::size_t q = 0; q < parts.size() && split_problem.empty(); ++q)
        if (q != p && parts[q].size() <= parts[p].size()) split_problem = gap_problem(stacks.front().frames, parts[q], files);
      for (Part& stack : stacks) {
        DicomVolume volume;
        volume.series = volume.name = series.description;
        volume.series_number = series.number;
        volume.series_index = series_index;
        volume.file = stack.frames.front()->file;
        if (p > 0) volume.name += ", " + geometry_suffix(*parts[p].front(), *parts[0].front(), files);
        if (!stack.suffix.empty()) volume.name += ", " + stack.suffix;
        volume.frames = std::move(stack.frames);
        volume.problem = split_problem;
        if (stacks.size() > 1 && !stack.told_apart)
          volume.notes.push_back("several images have the same position and indistinguishable headers: they are separated by image number");
        check_volume(volume, files);
        series_volumes.push_back(std::move(volume));
      }
    }
    for (DicomVolume& volume : series_volumes) {
      volume.name = make_unique_name(volume.name, [&](const std::string& name) {
        return std::ranges::any_of(volumes, [&](const DicomVolume& other) { return other.name == name; });
      });
      volumes.push_back(std::move(volume));
    }
    ++series_index;
  }
  number_volumes(volumes);
  return volumes;
}

}  // namespace catena::vtk
