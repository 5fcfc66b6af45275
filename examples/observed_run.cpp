// examples/observed_run.cpp: a run inside of another program. It prints a line for each output and stops by itself.
#include <cstdio>
#include <gaussdrift/gaussdrift.hpp>

// A cone that turns about the origin, in the words of a case file.
const char* const cone = R"(gaussdrift = 1
[domain]
min = [-1, -1]
max = [1, 1]
[velocity]
u = ["-y", "x"]
[density]
shape = "wendland"
center = [0.5, 0]
radius = 0.25
[particles]
per_axis = 150
[time]
end = "2*pi"
step = 0.05
[output]
times = [0, "pi/2", "pi", "2*pi"]
[reference]
kind = "characteristics"
)";

class Peak : public gaussdrift::Observer {
 public:
  std::string name() const override { return "peak"; }
  void frame(const gaussdrift::Frame& frame) override {  // density and particles are seen where they are
    std::printf("t = %5.3f  peak %.4f  mass %.6f  %zu particles  error %.1e\n", frame.time, frame.numbers.maximum,
                frame.numbers.mass, frame.particles->size(), frame.numbers.error->linf);
  }
};

int main() {
  try {
    const gaussdrift::ReadResult read = gaussdrift::parse_case(cone, "cone.toml", {"evaluate.per_axis=100"});
    gaussdrift::Simulation simulation(read.spec);
    simulation.observe(std::make_unique<Peak>());
    simulation.on_progress([](const gaussdrift::Progress& progress) { return progress.time < 3; });  // half a turn
    const gaussdrift::RunSummary half = simulation.run();
    std::printf("stopped at t = %.3f after %zu steps\n", half.time, half.steps);
    simulation.on_progress({});
    const gaussdrift::RunSummary whole = simulation.run();  // goes on, with the same bits as without the stop
    for (const std::string& warning : gaussdrift::warnings_of(read.spec, whole)) std::puts(warning.c_str());
    return !half.complete && whole.complete && whole.frames.size() == 4 ? 0 : 1;
  } catch (const gaussdrift::Error& error) {  // its text names place, rule and remedy
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
}
