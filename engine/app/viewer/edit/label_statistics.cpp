// SPDX-License-Identifier: MIT
#include "engine/app/viewer/edit/label_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <system_error>

#include "engine/base/csv.h"

namespace catena::app {

namespace {

LabelStatisticsCache::Table compute_statistics(const LabelStatisticsCache::Request& request, const scene::LabelTable& names) {
  const field::ScalarGrid& grid = *request.map->grid();
  CATENA_TRY(const field::MeasuredLabels measured, field::measure_labels(grid, request.values.get()));
  const double volume = field::voxel_volume(grid.mapping());
  std::vector<LabelStatistics> rows;
  for (const field::MeasuredLabel& label : measured.labels) {
    if (label.label == 0) continue;
    const double value = label.label;
    const auto name = std::ranges::lower_bound(names, value, {}, &scene::LabelRow::value);
    rows.push_back({value, name != names.end() && name->value == value ? name->name : "", label.voxels,
                    volume * static_cast<double>(label.voxels), label.values.mean(), label.values.deviation()});
  }
  return rows;
}

double number_in(const LabelStatistics& row, LabelColumn column) {
  switch (column) {
    case LabelColumn::voxels:
      return static_cast<double>(row.voxels);
    case LabelColumn::volume:
      return row.volume;
    case LabelColumn::mean:
      return row.mean;
    case LabelColumn::deviation:
      return row.deviation;
    case LabelColumn::name:
      break;
  }
  return 0;
}

/// Returns less than, equal to or more than 0 for the order of two rows; NaN last in both directions.
int compare_rows(const LabelStatistics& a, const LabelStatistics& b, LabelColumn column, bool descending) {
  const int sign = descending ? -1 : 1;
  if (column == LabelColumn::name) return sign * a.name.compare(b.name);
  const double left = number_in(a, column), right = number_in(b, column);
  if (std::isnan(left) || std::isnan(right)) return int(std::isnan(left)) - int(std::isnan(right));
  return left < right ? -sign : left > right ? sign : 0;
}

std::string number_cell(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

}  // namespace

void sort_labels(std::vector<LabelStatistics>& rows, LabelColumn column, bool descending) {
  std::sort(rows.begin(), rows.end(), [&](const LabelStatistics& a, const LabelStatistics& b) {
    const int order = compare_rows(a, b, column, descending);
    return order != 0 ? order < 0 : a.label < b.label;
  });
}

std::string labels_to_csv(const std::vector<LabelStatistics>& rows, bool with_values) {
  std::string text = with_values ? "label,name,voxels,volume,mean,deviation\n" : "label,name,voxels,volume\n";
  for (const LabelStatistics& row : rows) {
    text += fmt::format("{},{},{},{}", row.label, quoted_csv_cell(row.name), row.voxels, row.volume);
    text += with_values ? fmt::format(",{},{}\n", number_cell(row.mean), number_cell(row.deviation)) : "\n";
  }
  return text;
}

bool LabelStatisticsCache::collect() {
  if (!job_ || !job_->done) return false;
  request_ = std::move(job_->request);
  table_ = std::move(job_->table);
  job_.reset();
  return true;
}

std::shared_ptr<const LabelStatisticsCache::Table> LabelStatisticsCache::find_or_request(const Request& request,
                                                                                         const scene::LabelTable& names) {
  collect();
  if (table_ && request_ == request) return table_;
  if (job_) return nullptr;
  job_ = std::make_unique<Job>();
  job_->request = request;
  job_->names = names;
  try {
    job_->thread = std::jthread([job = job_.get()] {
      try {
        job->table = std::make_shared<const Table>(compute_statistics(job->request, job->names));
      } catch (const std::bad_alloc&) {
        job->table = std::make_shared<const Table>(Error{"the statistics need more memory than there is"});
      }
      job->done = true;
    });
  } catch (const std::system_error&) {
    job_.reset();  // no table until the next request
  }
  return nullptr;
}

}  // namespace catena::app
