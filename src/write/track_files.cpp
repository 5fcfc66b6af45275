#include "write/track_files.hpp"

#include <fmt/format.h>

#include <utility>

#include "base/state_bytes.hpp"
#include "sim/borders/departures.hpp"
#include "sim/follow/time_units.hpp"
#include "sim/grid_fields.hpp"
#include "write/growing_file.hpp"

namespace gaussdrift::write {

// Each in a file of its name.
TrackFileKind track_lines();
TrackFileKind track_netcdf();

namespace fs = std::filesystem;

namespace {

TrackColumns columns_of(const Case& spec) {
  TrackColumns columns{spec.domain.dimension, {}, reasons_to_leave(spec)};
  for (const GridField& field : spec.output.tracks->fields)
    columns.fields.emplace_back(field.name, find_grid_field(field.name).components(spec.domain.dimension));
  return columns;
}

class TrackWriter : public Observer {
 public:
  TrackWriter(const fs::path& folder, const Case& spec)
      : folder_(folder),
        files_(spec.output.tracks->files),
        columns_(columns_of(spec)),
        heading_{spec.title.empty() ? spec.name : spec.title, time_units_of(spec)},
        table_(folder / track_table_name),
        waiting_(columns_.heading()) {}
  std::string name() const override { return "write tracks"; }
  bool needs_particles(double /*time*/) const override { return false; }
  void frame(const Frame& /*frame*/) override { write_out(); }
  void tracks(const TrackSamples& samples) override {
    constexpr std::size_t most = 1 << 20;  // bytes that wait
    waiting_ += track_rows_text(samples);
    if (waiting_.size() > most) write_out();
  }
  // Rows that wait go with the state, so that it never runs ahead of the disk.
  std::string state() const override {
    base::StateBytes bytes;
    auto written = written_;
    std::string waiting = waiting_;
    bytes(written, waiting);
    return bytes.written();
  }
  void restore(const std::vector<std::pair<double, FrameNumbers>>& /*frames*/, const std::string& state) override {
    if (state.empty()) return;
    base::StateBytes bytes(state);
    bytes(written_, waiting_);
    bytes.end();
    if (written_ > 0) table_.take_up(static_cast<long>(written_));
  }
  void finish() override {
    write_out();
    if (files_.empty()) return;
    const TrackTable table(folder_ / track_table_name, columns_);
    for (const TrackFile& file : files_) {
      const TrackFileKind& kind = find_track_file(file.name);
      kind.write(folder_ / kind.file, table, heading_);
    }
  }

 private:
  void write_out() {
    if (waiting_.empty()) return;
    table_.append(waiting_);
    written_ += static_cast<std::int64_t>(waiting_.size());
    waiting_.clear();
  }

  const fs::path folder_;
  const std::vector<TrackFile> files_;
  const TrackColumns columns_;
  const TrackHeading heading_;
  GrowingFile table_;
  std::int64_t written_ = 0;  // bytes of the table
  std::string waiting_;       // rows that are not written yet
};

}  // namespace

const std::vector<TrackFileKind>& track_files() { return base::catalogue<TrackFileKind>(); }

const TrackFileKind& find_track_file(std::string_view name) {
  return base::find_named(track_files(), "file of tracks", name);
}

std::vector<std::string> track_file_names(const OutputSpec& output) {
  if (!output.tracks) return {};
  std::vector<std::string> names{track_table_name};
  for (const TrackFile& file : output.tracks->files) names.emplace_back(find_track_file(file.name).file);
  return names;
}

std::unique_ptr<Observer> track_writer(const fs::path& folder, const Case& spec) {
  return std::make_unique<TrackWriter>(folder, spec);
}

}  // namespace gaussdrift::write

template <>
std::vector<gaussdrift::write::TrackFileKind>& gaussdrift::base::catalogue<gaussdrift::write::TrackFileKind>() {
  using namespace gaussdrift::write;
  static std::vector<TrackFileKind> all{track_lines(), track_netcdf()};
  return all;
}
