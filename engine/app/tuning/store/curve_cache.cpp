// SPDX-License-Identifier: MIT
#include "engine/app/tuning/store/curve_cache.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "engine/app/cli/io_conflicts.h"
#include "engine/app/tuning/report/report.h"
#include "engine/app/tuning/report/system_info.h"
#include "engine/base/json_edit.h"
#include "engine/base/numbers.h"
#include "engine/base/output_file.h"
#include "engine/base/text.h"

namespace catena::app::tuning {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxCachedPoints = 1000, kMaxCachedCurves = 100, kEnd = 65536;
constexpr std::uint64_t kMaxBytes = std::uint64_t{4} << 20;
constexpr const char* kKey = "key";

bool is_sane(double value) { return std::isnan(value) || (std::isfinite(value) && value >= 0); }

/// Returns whether all numbers of the curve are possible results of a measurement.
bool is_sane(const Curve& curve) {
  const auto point = [](const tuning::Point& p) {
    return is_sane(p.error) && is_sane(p.work) && is_sane(p.bytes) && is_sane(p.time.median) && is_sane(p.time.lower_quartile) &&
           is_sane(p.time.upper_quartile) && !(p.time.median <= 0);
  };
  return curve.points.size() <= kMaxCachedPoints && is_sane(curve.discretization_error) && is_sane(curve.reference_error) &&
         std::all_of(curve.points.begin(), curve.points.end(), point);
}

}  // namespace

CurveKey::CurveKey(std::string_view sense) {
  add(sense);
  for (const auto& [name, value] : system_info())
    if (name != "date") add(value);
  add_file("/proc/self/exe");
  const char* threads = std::getenv("LP_NUM_THREADS");
  add(threads != nullptr ? threads : "");
}

CurveKey& CurveKey::add(std::string_view words) {
  hash_.add_text(words);
  return *this;
}

CurveKey& CurveKey::add(double number) { return add(to_text(number)); }

void CurveKey::add_file(const std::string& path) {
  struct ::stat about {};
  add(path);
  if (::stat(path.c_str(), &about) != 0) return;
  add(fmt::format("{} {} {}", about.st_size, about.st_mtim.tv_sec, about.st_mtim.tv_nsec));
  if (!S_ISREG(about.st_mode)) return;
  std::ifstream in(path, std::ios::binary);
  std::string bytes(kEnd, '\0');
  for (const std::streamoff from : {std::streamoff{0}, std::max(std::streamoff{0}, std::streamoff{about.st_size} - std::streamoff{kEnd})}) {
    in.clear();
    in.seekg(from);
    in.read(bytes.data(), static_cast<std::streamsize>(kEnd));
    add(std::string_view(bytes).substr(0, static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount()))));
  }
}

CurveKey& CurveKey::add(const scene::Scene& scene, std::string_view text) {
  const auto root = json::parse(text, scene.path);
  if (root)
    for (const auto& [name, node] : root->members) {
      if (name == "quality") continue;
      json::Node settings = node;
      if (name == "coupling")
        std::erase_if(settings.members, [](const auto& m) { return m.first == "max_proxy_error" || m.first == "max_tick_us"; });
      if (name != "coupling" || !settings.members.empty()) add(name).add(json::serialize_node(settings));
    }
  add(static_cast<double>(scene.time.step));
  std::vector<std::string> files = scene.referenced_files;
  if (!root) files.push_back(scene.path);
  for (const std::string& file : files) {
    add_file(file);
    std::error_code code;
    std::vector<std::string> inside;
    if (fs::is_directory(file, code))
      for (const fs::directory_entry& entry : fs::directory_iterator(file, code)) inside.push_back(entry.path().string());
    std::sort(inside.begin(), inside.end());
    for (const std::string& entry : inside) add_file(entry);
  }
  return *this;
}

std::string CurveKey::text() const { return fmt::format("{:016x}", hash_.value); }

CurveCache::CurveCache() : CurveCache(user_folder("XDG_CACHE_HOME", ".cache")) {
  if (!folder_.empty()) folder_ += "/plans";
}

std::optional<std::vector<Curve>> CurveCache::find(const std::string& key, const std::function<bool(const std::vector<Curve>&)>& fits,
                                                   std::string& message) const {
  const std::string path = path_of(key);
  std::error_code code;
  if (path.empty() || fs::symlink_status(path, code).type() == fs::file_type::not_found) return std::nullopt;
  const auto refuse = [&](const std::string& reason) {
    message = path + ": " + reason + "; the file is ignored, and the costs are measured anew";
    return std::nullopt;
  };
  if (!fs::is_regular_file(path, code)) return refuse("is not a file");
  if (fs::file_size(path, code) > kMaxBytes || code) return refuse("the file is too large for cost curves");
  auto report = tuning::read_report(path);
  if (!report) return refuse("the file is damaged");
  const auto& about = report->metadata;
  const bool is_ours = std::find(about.begin(), about.end(), std::pair<std::string, std::string>(kKey, key)) != about.end();
  if (!is_ours) return refuse("the file belongs to another scene or machine");
  const bool sane = report->curves.size() <= kMaxCachedCurves &&
                    std::all_of(report->curves.begin(), report->curves.end(), [](const Curve& curve) { return is_sane(curve); });
  if (!sane || !fits(report->curves)) return refuse("the file contains impossible values");
  return std::move(report->curves);
}

Outcome CurveCache::store(const std::string& key, const std::string& source, const std::vector<Curve>& curves) const {
  if (folder_.empty()) return Done{};
  std::error_code code;
  fs::create_directories(folder_, code);
  tuning::Report report;
  report.source = fs::path(source).filename().string();
  report.metadata = system_info();
  report.metadata.emplace_back(kKey, key);
  report.curves = curves;
  CATENA_TRY(OutputFile file, OutputFile::open(path_of(key)));
  file.write(tuning::to_json(report));
  return file.commit();
}

}  // namespace catena::app::tuning
