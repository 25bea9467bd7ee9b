// SPDX-License-Identifier: MIT
#include "render/frame/camera_path.h"

#include <algorithm>
#include <cmath>

#include "engine/base/camera_limits.h"
#include "engine/base/csv.h"
#include "engine/base/numbers.h"
#include "engine/base/result.h"

namespace catena::render {
namespace {

const std::vector<std::string_view> kRequired{"t", "px", "py", "pz", "tx", "ty", "tz"};
const std::vector<std::string_view> kOptional{"ux,uy,uz", "fovy"};

Result<CameraPath> path_of(const NumberTable& table) {
  const auto value = [&](std::string_view column, std::size_t row) { return (*table.find(column))[row]; };
  std::vector<CameraKey> keys(table.rows());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    CameraKey& key = keys[i];
    const auto refuse = [&](const std::string& what) {
      return Error{table.file + ":" + std::to_string(table.line_number(i)) + ": " + what};
    };
    key.t_s = value("t", i);
    key.position = {value("px", i), value("py", i), value("pz", i)};
    key.target = {value("tx", i), value("ty", i), value("tz", i)};
    if (i > 0 && !(key.t_s > keys[i - 1].t_s))
      return refuse("t is " + to_text(key.t_s) + " after " + to_text(keys[i - 1].t_s) + "; strictly rising t was expected");
    if (const std::string problem = validate_view(key.position, key.target); !problem.empty()) return refuse(problem);
    if (table.find("ux") != nullptr) {
      key.up = Vec3(value("ux", i), value("uy", i), value("uz", i));
      if (!(norm(*key.up) > 0)) return refuse("up is 0,0,0; a direction was expected");
    }
    if (table.find("fovy") != nullptr) {
      key.fovy_deg = value("fovy", i);
      if (const std::string problem = validate_fovy(*key.fovy_deg); !problem.empty()) return refuse("fovy " + problem);
    }
  }
  return CameraPath(std::move(keys));
}

}  // namespace

CameraPath::CameraPath(std::vector<CameraKey> keys) : keys_(std::move(keys)) {
  CATENA_ASSERT(!keys_.empty());
  for (std::size_t i = 1; i < keys_.size(); ++i) CATENA_ASSERT(keys_[i].t_s > keys_[i - 1].t_s);
}

View CameraPath::at(const View& base, double t_s) const {
  const double t = std::clamp(t_s, keys_.front().t_s, keys_.back().t_s);
  // the keys before and after t
  const auto later = std::ranges::upper_bound(keys_, t, {}, &CameraKey::t_s);
  const std::size_t next = std::max<std::size_t>(1, static_cast<std::size_t>(later - keys_.begin()));
  const std::size_t to = std::min(next, keys_.size() - 1), from = keys_.size() == 1 ? 0 : to - 1;
  const double length = keys_[to].t_s - keys_[from].t_s, s = length > 0 ? (t - keys_[from].t_s) / length : 0;

  const auto curve = [&](Vec3 CameraKey::*member) {
    if (from == to) return keys_[from].*member;
    const auto tangent = [&](std::size_t i) {
      const CameraKey &a = keys_[i == 0 ? 0 : i - 1], &b = keys_[std::min(i + 1, keys_.size() - 1)];
      return (b.*member - a.*member) * (length / (b.t_s - a.t_s));
    };
    const double s2 = s * s, s3 = s2 * s;
    return keys_[from].*member * (2 * s3 - 3 * s2 + 1) + tangent(from) * (s3 - 2 * s2 + s) + keys_[to].*member * (3 * s2 - 2 * s3) +
           tangent(to) * (s3 - s2);
  };
  View view = base;
  view.position = curve(&CameraKey::position);
  view.target = curve(&CameraKey::target);
  if (keys_[from].up) {
    const Vec3 a = direction(*keys_[from].up), b = direction(*keys_[to].up), mean = a * (1 - s) + b * s;
    view.up = norm(mean) > 1e-9 ? direction(mean) : a;
  }
  if (keys_[from].fovy_deg) view.fovy_deg = *keys_[from].fovy_deg * (1 - s) + *keys_[to].fovy_deg * s;
  return view;
}

Result<CameraPath> read_camera_path(const std::string& path) {
  CATENA_TRY(const NumberTable table, read_csv(path, kRequired, kOptional));
  return path_of(table);
}

Result<CameraPath> parse_camera_path(std::string_view text, const std::string& file) {
  CATENA_TRY(const NumberTable table, parse_csv(text, file, kRequired, kOptional));
  return path_of(table);
}

}  // namespace catena::render
