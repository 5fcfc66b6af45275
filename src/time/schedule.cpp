#include "time/schedule.hpp"

#include <cmath>

namespace gaussdrift::time {

Interval::Interval(double begin, double end, double step) : begin_(begin), end_(end), step_(step), steps_(0) {
  if (end > begin) steps_ = static_cast<std::size_t>(std::fmax(1.0, std::ceil((end - begin) / step - 1e-9)));
}

}  // namespace gaussdrift::time
