#include "cli/run_observers.hpp"

#include "base/has_one.hpp"
#include "cli/terminal.hpp"
#include "render/film_frames.hpp"
#include "render/picture.hpp"
#include "render/picture_series.hpp"
#include "write/output_files.hpp"
#include "write/series_table.hpp"
#include "write/track_files.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

/// Of the density, and of each that has a name.
void observe_pictures(Simulation& simulation, const Case& spec, const fs::path& folder, bool beside,
                      std::vector<std::string>& later) {
  std::vector<std::string> tracers{""};
  if (spec.output.pictures.field.empty())
    for (const TracerSpec& tracer : spec.tracers) tracers.push_back(tracer.name);
  for (const std::string& tracer : tracers)
    simulation.observe(
        render::picture_series(folder, spec.output.images, spec.title.empty() ? spec.name : spec.title,
                               {.warn = [&](const std::string& line) { later.push_back(line); },
                                .date = spec.time.date,
                                .tracer = tracer,
                                .label = spec.label,
                                .sphere = spec.domain.sphere,
                                .looks = spec.output.pictures,
                                .beside = beside,
                                .run_writes_densities = base::has_one(spec.output.files, &OutputFile::shows_density)}));
}

}  // namespace

void add_observers(Simulation& simulation, const Case& spec, const fs::path& folder, bool core_is_free,
                   std::vector<std::string>& later) {
  simulation.observe(write::series_table(folder, spec.domain.dimension,
                                         spec.reference.kind != ReferenceSpec::Kind::none, spec.time.date));
  for (const OutputFile& file : spec.output.files)
    simulation.observe(write::file_series(write::find_output_file(file.name), folder));
  if (spec.output.tracks) simulation.observe(write::track_writer(folder, spec));
  if (const auto& images = spec.output.images; !images.empty() || spec.output.animation) {
    if (const std::string reason = render::unavailable_reason(); !reason.empty())
      note("warning: no pictures are drawn: {}\n", reason);
    else {
      if (!images.empty()) observe_pictures(simulation, spec, folder, core_is_free, later);
      if (spec.output.animation) simulation.observe(render::film_frames(folder));
    }
  }
}

void observe_pieces(Simulation& simulation, const Case& spec, const fs::path& folder) {
  for (const OutputFile& file : spec.output.files)
    if (const write::FileKind& kind = write::find_output_file(file.name); kind.index)
      simulation.observe(write::file_series(kind, folder));
}

}  // namespace gaussdrift::cli
