// A Case as a case file again, every default spelt out: table after table, as they are read.
#include "gaussdrift/read_case.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift {

using namespace input;  // this is the public face of that module

std::string case_text(const Case& spec, const std::filesystem::path& folder) {
  Writer out(folder);
  write_heading(out, spec);
  write_params(out, spec);
  write_domain(out, spec.domain);
  write_velocity(out, spec.velocity);
  write_density(out, spec);
  write_sources(out, spec);
  write_particles(out, spec.particles);
  write_time(out, spec.time);
  write_evaluate(out, spec.evaluate);
  write_output(out, spec.output, spec.time);
  write_pictures(out, spec.output.pictures);
  write_tracks(out, spec.output);
  write_effects(out, spec.effects);
  write_reference(out, spec.reference);
  write_accuracy(out, spec.accuracy);
  write_checks(out, spec.checks, spec.time);
  return out.text();
}

}  // namespace gaussdrift
