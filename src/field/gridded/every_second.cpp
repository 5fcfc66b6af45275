#include "field/gridded/every_second.hpp"

#include <array>
#include <cstddef>

namespace gaussdrift {

namespace {

std::vector<std::size_t> every_second(std::size_t count) {
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < count; i += 2) some.push_back(i);
  if (count % 2 == 0 && count > 0) some.push_back(count - 1);
  return some;
}

template <class Number>
std::vector<Number> taken(const std::vector<Number>& all, const std::vector<std::size_t>& which) {
  std::vector<Number> some;
  for (const std::size_t i : which) some.push_back(all[i]);
  return some;
}

}  // namespace

std::shared_ptr<const GridData> every_second_point(const GridData& data) {
  auto coarse = std::make_shared<GridData>(data);
  std::array<std::vector<std::size_t>, max_dimension> which{{{0}, {0}, {0}}};
  for (int k = 0; k < data.dimension; ++k) {
    which[k] = every_second(data.axis[k].size());
    coarse->axis[k] = taken(data.axis[k], which[k]);
  }
  const std::size_t row = data.axis[0].size(), plane = data.dimension == 3 ? row * data.axis[1].size() : 0;
  for (std::size_t t = 0; t < data.values.size(); ++t) {
    std::vector<double>& values = coarse->values[t];
    values.clear();
    for (const std::size_t c : which[2])
      for (const std::size_t b : which[1])
        for (const std::size_t a : which[0]) {
          const auto first = static_cast<std::ptrdiff_t>((c * plane + b * row + a) * data.components);
          values.insert(values.end(), data.values[t].begin() + first,
                        data.values[t].begin() + first + static_cast<std::ptrdiff_t>(data.components));
        }
  }
  return coarse;
}

std::shared_ptr<const GridData> every_second_time(const GridData& data) {
  auto coarse = std::make_shared<GridData>(data);
  const std::vector<std::size_t> which = every_second(data.times.size());
  coarse->times = taken(data.times, which);
  coarse->values = taken(data.values, which);
  return coarse;
}

}  // namespace gaussdrift
