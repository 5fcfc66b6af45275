#include "write/series_table.hpp"

#include <fmt/format.h>

#include "base/stopwatch.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;

namespace {

class SeriesTable : public Observer {
 public:
  SeriesTable(const fs::path& folder, int dimension, bool errors)
      : file_(folder / series_name), dimension_(dimension), errors_(errors) {
    table_ = "t,mass,minimum,maximum,centroid_x,centroid_y";
    table_ += dimension == 3 ? ",centroid_z" : "";
    table_ += ",transform_error";
    table_ += errors ? ",L1,L2,Linf" : "";
    table_ += ",outside,evaluate_seconds,seconds\n";
  }
  std::string name() const override { return "write series"; }
  void frame(const Frame& frame) override {
    const FrameNumbers& n = frame.numbers;
    table_ += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g}", frame.time, n.mass, n.minimum, n.maximum);
    for (int k = 0; k < dimension_; ++k) table_ += fmt::format(",{:.17g}", n.centroid[k]);
    table_ += fmt::format(",{:.3e}", n.transform_error);
    const ErrorNorms error = n.error.value_or(ErrorNorms{});
    if (errors_) table_ += fmt::format(",{:.6e},{:.6e},{:.6e}", error.l1, error.l2, error.linf);
    table_ += fmt::format(",{:.17g},{:.6f},{:.6f}\n", n.outside, n.evaluate_seconds, watch_.seconds());
    write_text(file_, table_);
  }

 private:
  fs::path file_;
  int dimension_;
  bool errors_;
  std::string table_;
  base::Stopwatch watch_;  // runs from the start of the run
};

}  // namespace

std::unique_ptr<Observer> series_table(const fs::path& folder, int dimension, bool errors) {
  return std::make_unique<SeriesTable>(folder, dimension, errors);
}

}  // namespace gaussdrift::write
