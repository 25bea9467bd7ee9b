// SPDX-License-Identifier: MIT
/// Statistics of the labels of a label map for the panel Measure, computed on a separate thread so that no frame waits. Frame thread.
#pragma once
#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "engine/field/measure/labels.h"
#include "engine/scene/label_table.h"

namespace catena::app {

/// One label of the table.
struct LabelStatistics {
  double label = 0;
  std::string name;          ///< Empty: none.
  std::uint64_t voxels = 0;  ///< Voxels that hold it.
  double volume = 0;         ///< Cubed world units.
  /// Mean and standard deviation (divisor N - 1) of the chosen field; NaN: no field, or too few values.
  double mean = 0, deviation = 0;
};

/// Columns of the table, in their order in the window and in the CSV.
enum class LabelColumn { name, voxels, volume, mean, deviation };

/// Sorts the rows by a column, equal ones by their label. Names are in the order of the alphabet, labels without a name first; rows without
/// a value are last in both directions.
void sort_labels(std::vector<LabelStatistics>& rows, LabelColumn column, bool descending);
/// Returns the rows as CSV: label,name,voxels,volume, and mean,deviation if `with_values`.
std::string labels_to_csv(const std::vector<LabelStatistics>& rows, bool with_values);

/// The newest table, and the thread that computes the next one. Memory: one table of at most 65536 rows.
class LabelStatisticsCache {
 public:
  /// What is measured: a label map on a grid, and a field for mean and deviation, or null.
  struct Request {
    std::shared_ptr<const field::ScalarField> map, values;
    bool operator==(const Request&) const = default;
  };
  /// The rows without label 0, ascending; or an error in one line.
  using Table = Result<std::vector<LabelStatistics>>;

  /// Returns the table, or nullptr until it is available; requests it. `names`: those of the map.
  std::shared_ptr<const Table> find_or_request(const Request& request, const scene::LabelTable& names);
  /// Takes over a table that the thread has completed; returns true if there was one.
  bool collect();

 private:
  struct Job {
    Request request;
    scene::LabelTable names;
    std::shared_ptr<const Table> table;
    std::atomic<bool> done = false;
    std::jthread thread;  ///< Last member: joined before the others are destroyed.
  };

  Request request_;  ///< That of `table_`.
  std::shared_ptr<const Table> table_;
  std::unique_ptr<Job> job_;
};

}  // namespace catena::app
