#include "write/view_script.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/longest_side.hpp"
#include "write/output_files.hpp"
#include "write/track_files.hpp"

namespace gaussdrift::write {

std::string view_script(const Case& spec) {
  std::string script(view_files().front().bytes);
  script += fmt::format("DIMENSION = {}\nSIDE = {:.17g}  # the longest of the domain\n", spec.domain.dimension,
                        longest_side(spec.domain.dimension, spec.domain.min, spec.domain.max));
  for (const FileKind& kind : output_files()) {
    if (std::none_of(spec.output.files.begin(), spec.output.files.end(),
                     [&](const OutputFile& file) { return file.name == kind.about.name; }))
      continue;
    script += fmt::format("{0} = open_series(\"{0}\")\n", kind.about.name);
    if (kind.view) script += "view = next_view()\n" + kind.view(spec.domain.dimension);
  }
  if (spec.output.tracks) {
    script += "view = views[0] if views else next_view()\n";
    for (const TrackFile& file : spec.output.tracks->files)
      if (const TrackFileKind& kind = find_track_file(file.name); kind.view) script += kind.view(kind.file);
  }
  return script +
         "if views:\n"
         "    look()\n"
         "    RenderAllViews()\n"
         "    if \"VIEW_PNG\" in os.environ:\n"
         "        for view in views:\n"
         "            view.ViewSize = [800, 800]\n"
         "        SaveScreenshot(os.environ[\"VIEW_PNG\"], GetLayout(views[0]), ImageResolution=[800 * len(views), "
         "800],\n"
         "                       FontScaling=\"Do not scale fonts\")\n";
}

}  // namespace gaussdrift::write
