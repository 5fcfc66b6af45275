#include "write/series_table.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "write/growing_file.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;

namespace {

std::string heads_of(const TracerNumbers& tracer) {
  std::string heads;
  const auto add = [&](const char* what) { heads += fmt::format(",{}_{}", what, tracer.name); };
  for (const char* what : {"mass", "minimum", "maximum"}) add(what);
  if (tracer.released) add("released");
  if (tracer.reacted) add("reacted");
  if (tracer.left) add("left");
  if (tracer.error)
    for (const char* what : {"L1", "L2", "Linf"}) add(what);
  return heads;
}

std::string numbers_of(const TracerNumbers& tracer) {
  std::string row = fmt::format(",{:.17g},{:.17g},{:.17g}", tracer.mass, tracer.minimum, tracer.maximum);
  for (const auto& number : {tracer.released, tracer.reacted, tracer.left})
    if (number) row += fmt::format(",{:.17g}", *number);
  if (tracer.error) row += fmt::format(",{:.6e},{:.6e},{:.6e}", tracer.error->l1, tracer.error->l2, tracer.error->linf);
  return row;
}

class SeriesTable : public Observer {
 public:
  SeriesTable(const fs::path& folder, int dimension, bool errors, std::function<std::string(double t)> date)
      : text_(folder / series_name), dimension_(dimension), errors_(errors), date_(std::move(date)) {}
  std::string name() const override { return "write series"; }
  bool needs_particles(double /*time*/) const override { return false; }
  void frame(const Frame& frame) override {
    if (begun_)
      text_.append(row(frame.time, frame.numbers));
    else
      begin({{frame.time, frame.numbers}});
  }
  void restore(const std::vector<std::pair<double, FrameNumbers>>& frames, const std::string& /*state*/) override {
    if (!frames.empty()) begin(frames);
  }

 private:
  void begin(const std::vector<std::pair<double, FrameNumbers>>& frames) {
    std::string table = date_ ? "t,date," : "t,";
    table += "mass,minimum,maximum,centroid_x,centroid_y";
    table += dimension_ == 3 ? ",centroid_z" : "";
    table += ",transform_error";
    table += errors_ ? ",L1,L2,Linf" : "";
    table += ",outside";
    const FrameNumbers& first = frames.front().second;
    if (first.inside) table += ",inside";
    if (first.stopped) table += ",stopped";
    for (const Departed& departed : first.left) table += ",left_" + departed.reason;
    if (first.released) table += ",released";
    if (first.decayed) table += ",decayed";
    for (const TracerNumbers& tracer : first.tracers) table += heads_of(tracer);
    table += ",evaluate_seconds,seconds\n";
    for (const auto& [time, numbers] : frames) table += row(time, numbers);
    text_.begin(table);
    begun_ = true;
  }

  std::string row(double time, const FrameNumbers& n) const {
    std::string row = fmt::format("{:.17g},", time);
    if (date_) row += date_(time) + ",";
    row += fmt::format("{:.17g},{:.17g},{:.17g}", n.mass, n.minimum, n.maximum);
    for (int k = 0; k < dimension_; ++k) row += fmt::format(",{:.17g}", n.centroid[k]);
    row += fmt::format(",{:.3e}", n.transform_error);
    const ErrorNorms error = n.error.value_or(ErrorNorms{});
    if (errors_) row += fmt::format(",{:.6e},{:.6e},{:.6e}", error.l1, error.l2, error.linf);
    row += fmt::format(",{:.17g}", n.outside);
    if (n.inside) row += fmt::format(",{:.17g}", *n.inside);
    if (n.stopped) row += fmt::format(",{:.17g}", n.stopped->mass);
    for (const Departed& departed : n.left) row += fmt::format(",{:.17g}", departed.mass);
    if (n.released) row += fmt::format(",{:.17g}", *n.released);
    if (n.decayed) row += fmt::format(",{:.17g}", *n.decayed);
    for (const TracerNumbers& tracer : n.tracers) row += numbers_of(tracer);
    return row + fmt::format(",{:.6f},{:.6f}\n", n.evaluate_seconds, n.seconds);
  }

  GrowingFile text_;
  int dimension_;
  bool errors_;
  std::function<std::string(double t)> date_;  // empty: times have none
  bool begun_ = false;
};

}  // namespace

std::unique_ptr<Observer> series_table(const fs::path& folder, int dimension, bool errors,
                                       std::function<std::string(double t)> date) {
  return std::make_unique<SeriesTable>(folder, dimension, errors, std::move(date));
}

}  // namespace gaussdrift::write
