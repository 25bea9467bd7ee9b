#include <cmath>

#include "engine/base/assert.h"
#include "render/extract/extract.h"

namespace catena::render {

TransferTable transfer_table(const scene::TransferFunction& transfer, const field::ScalarField& field) {
  CATENA_ASSERT(!transfer.colors.empty() && !(transfer.extinctions.empty() && transfer.opacities.empty()));
  TransferTable table;
  for (const auto& c : transfer.colors) table.colors.push_back({c.value, c.color.r, c.color.g, c.color.b});
  for (const auto& e : transfer.extinctions) table.extinctions.push_back({e.value, e.sigma});
  for (const auto& g : transfer.gradient_factors) table.gradient_factors.push_back({g.gradient, g.factor});
  table.opacity_unit = transfer.opacity_unit;
  if (!table.extinctions.empty()) return table;
  const double unit = transfer.opacity_unit > 0 ? transfer.opacity_unit : field.mapping().smallest_edge();
  for (const auto& o : transfer.opacities) table.extinctions.push_back({o.value, -std::log1p(-o.alpha) / unit});
  return table;
}

}  // namespace catena::render
