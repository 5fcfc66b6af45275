// Each wrong input is refused with its place, the rule and a remedy.
#include <gtest/gtest.h>

#include <sstream>

#include "cases.hpp"

namespace gaussdrift::input {
namespace {

TEST(CaseFile, RejectsAnUnknownKeyNamingTheLine) {
  EXPECT_EQ(errors(with(cone, "overlap = 2", "overlapp = 2")),
            R"text(error: unknown key "overlapp" in [particles]; did you mean "overlap"?
  --> cone.toml:26:1
   |
26 | overlapp = 2
   | ^^^^^^^^
   = known keys: per_axis, overlap, cutoff, width_ratio, threshold

1 error in cone.toml)text");
}

TEST(CaseFile, PointsIntoExpressions) {
  EXPECT_EQ(errors(with(cone, "\"-y\", \"x\"", "\"-y\", \"x + siin(x)\"")),
            R"text(error: unknown function "siin"; did you mean "sin"?
  --> cone.toml:16:17
   |
16 | u = ["-y", "x + siin(x)"]
   |                 ^^^^

1 error in cone.toml)text");
}

TEST(CaseFile, LaysOutSyntaxErrorsLikeAllOthers) {
  EXPECT_EQ(errors("gaussdrift = 1\n[domain\nmin = [0, 0]\n"),
            R"text(error: cannot read this table header: expected ']', saw '\n'
 --> cone.toml:2:8
  |
2 | [domain
  |        ^
  = the file is not TOML here; the rest is checked once this is mended

1 error in cone.toml)text");
}

TEST(CaseFile, NamesTheOverrideAsThePlace) {
  EXPECT_EQ(errors(cone, {"time.step=0"}), R"text(error: time.step must be greater than 0, found 0
  --> --set time.step=0
                      ^
   = step: time step; the last one before an output is shortened to end there

1 error in cone.toml and --set)text");
  EXPECT_EQ(errors(cone, {"velocity.u=[\"y\",\"z\"]"}), R"text(error: z exists only in 3D; the domain has 2 dimensions
  --> --set velocity.u=["y","z"]
                             ^

1 error in cone.toml and --set)text");
}

TEST(CaseFile, ReportsAllErrorsInOnePassInTheOrderOfTheFile) {
  std::string text = with(cone, "R = 0.25", "R = 0.25\nA = \"1/0\"");
  text = with(text, "overlap = 2", "overlapp = 2");
  text = with(text, "step = 0.001", "step = -1");
  EXPECT_EQ(errors(text, {"evaluate.method=fast"}), R"text(error: params.A must be finite, found inf (from "1/0")
 --> cone.toml:9:5
  |
9 | A = "1/0"
  |     ^^^^^

error: unknown key "overlapp" in [particles]; did you mean "overlap"?
  --> cone.toml:27:1
   |
27 | overlapp = 2
   | ^^^^^^^^
   = known keys: per_axis, overlap, cutoff, width_ratio, threshold

error: time.step must be greater than 0, found -1
  --> cone.toml:32:8
   |
32 | step = -1
   |        ^^
   = step: time step; the last one before an output is shortened to end there

error: unknown value "fast" for evaluate.method
  --> --set evaluate.method=fast
                            ^^^^
   = known values: "auto", "direct", "hermite", "cells", "outer", "chebyshev", "spread"

4 errors in cone.toml and --set)text");
}

TEST(CaseFile, SaysWhatAnEmptyFileLacks) {
  EXPECT_EQ(errors(""),
            "error: the file does not say which version of the format it has\n --> cone.toml:1:1\n  |\n1 | \n  | ^\n"
            "  = begin the file with: gaussdrift = 1\n\n"
            "error: missing tables: [domain], [velocity], [density], [particles], [time]\n --> cone.toml:1:1\n  |\n1 | "
            "\n  | ^\n"
            "  = a case has at least [domain], [velocity], [density], [particles] and [time]\n\n2 errors in cone.toml");
}

TEST(CaseFile, KeepsCaretsInPlaceBehindTabsAndLettersOfSeveralBytes) {
  EXPECT_NE(errors(with(cone, "overlap = 2", "\toverlapp = 2")).find("26 | \toverlapp = 2\n   | \t^^^^^^^^\n"),
            std::string::npos);
  const std::string found =
      errors(with(cone, "title = \"Rotating cone\"\ncite = \"Schroeder 2006\"", "title = \"Größe\", x = 1"));
  EXPECT_NE(found.find("4 | title = \"Größe\", x = 1\n  |                ^\n"), std::string::npos) << found;
}

/// One edit of `cone` that gives one error.
struct Wrong {
  const char *old_part, *new_part;
  int line;
  const char* marked;  // what the carets stand under
  const char* message;
  const char* note = "";
};

/// The layout, written here once more.
std::string expected(const std::string& text, const Wrong& wrong) {
  std::istringstream lines(text);
  std::string line;
  for (int k = 0; k < wrong.line; ++k) std::getline(lines, line);
  const std::string marked = wrong.marked;
  const std::size_t column = line.rfind(marked);
  const std::string number = std::to_string(wrong.line), margin(number.size(), ' ');
  std::string result = "error: " + std::string(wrong.message) + "\n";
  result += margin + "--> cone.toml:" + number + ":" + std::to_string(column + 1) + "\n" + margin + " |\n";
  result +=
      number + " | " + line + "\n" + margin + " | " + std::string(column, ' ') + std::string(marked.size(), '^') + "\n";
  if (*wrong.note) result += margin + " = " + wrong.note + "\n";
  return result + "\n1 error in cone.toml";
}

const char* const step_note = "step: time step; the last one before an output is shortened to end there";
const char* const names_note = "reserved names: x, y, z, t, pi, e and the functions";
const char* const tables_note =
    "known tables: case, params, domain, velocity, density, source, particles, time, evaluate, output, reference, "
    "accuracy, "
    "check, "
    "effects";

const char* const effects_note = "known effects: reaction, diffusion, charge, vortex, remesh";

const std::vector<Wrong> wrongs = {
    // version and structure
    {"gaussdrift = 1", "gaussdrift = 2", 1, "2", "this program reads version 1 of the format, the file has version 2"},
    {"gaussdrift = 1", "gaussdrift = \"1\"", 1, "\"1\"",
     "gaussdrift must be the version of the format, found the string \"1\"", "begin the file with: gaussdrift = 1"},
    {"gaussdrift = 1", "gausdrift = 1", 1, "gausdrift",
     "unknown key \"gausdrift\" at the top of the file; did you mean \"gaussdrift\"?", tables_note},
    {"[domain]\n", "[domain]\nperiodic = true\n", 12, "periodic", "unknown key \"periodic\" in [domain]",
     "edges = [\"periodic\", \"closed\"] in [domain] has a word for each axis: periodic, closed (a wall), open or "
     "unbounded"},
    {"[domain]\n", "[domain]\nboundary = \"wall\"\n", 12, "boundary", "unknown key \"boundary\" in [domain]",
     "edges = [\"periodic\", \"closed\"] in [domain] has a word for each axis: periodic, closed (a wall), open or "
     "unbounded"},
    {"[particles]\n", "[Boundary-Conditions]\nleft = 0\n[particles]\n", 24, "Boundary-Conditions",
     "unknown table [Boundary-Conditions]",
     "edges = [\"periodic\", \"closed\"] in [domain] has a word for each axis: periodic, closed (a wall), open or "
     "unbounded"},
    {"[time]\nend", "[effects.gravity]\ng = 9.81\n[time]\nend", 29, "gravity", "unknown effect \"gravity\"",
     "the velocity is prescribed, in [velocity]; no equation of motion is solved"},
    {"[velocity]\n", "[velocity]\ndiffusivity = 1\n", 16, "diffusivity", "unknown key \"diffusivity\" in [velocity]",
     "[effects.diffusion] with the coefficient D"},
    {"step = 0.001", "dt = 0.001", 31, "dt", "unknown key \"dt\" in [time]; did you mean time.step?",
     "time.step is the time step; method = \"dopri5\" chooses its own"},
    {"images = [\"surface\"]", "images = [\"png\"]", 42, "\"png\"",
     "unknown value \"png\" for entry 1 of output.images",
     "output.vtk writes files for ParaView, series.csv has numbers for every output time, pictures are PNG; known "
     "values: \"surface\", \"contour\", \"heatmap\", \"arrows\", \"streamlines\", \"slices\", \"projection\", "
     "\"isosurface\", \"error\""},
    {"gaussdrift = 1", "gaussdrift = 1\nstep = 0.1", 2, "step",
     "unknown key \"step\" at the top of the file; it belongs in [time]", tables_note},
    {"[evaluate]", "[evaluation]", 34, "evaluation", "unknown table [evaluation]; did you mean [evaluate]?",
     tables_note},
    {"[particles]", "[particle]", 24, "particle", "unknown table [particle]; did you mean [particles]?", tables_note},
    {"[particles]", "[[particles]]", 24, "particles", "particles must be one table [particles], found a list"},
    {"[velocity]\nu = [\"-y\", \"x\"]", "[[velocity]]\nu = [1, 2]\n[[velocity]]\nfield = \"rotation\"\nrate = true", 19,
     "true", "velocity[2].rate must be a number or an expression, found true"},
    {"[time]\nend", "[effects.reacton]\nrate = 1\n[time]\nend", 29, "reacton",
     "unknown effect \"reacton\"; did you mean [effects.reaction]?", effects_note},
    {"[time]\nend", "[effects.magic]\nrate = 1\n[time]\nend", 29, "magic", "unknown effect \"magic\"", effects_note},
    {"[time]\nend", "[reaction]\nrate = 1\n[time]\nend", 29, "reaction",
     "unknown table [reaction]; did you mean [effects.reaction]?", tables_note},
    {"[time]\nend", "[effects]\nreaction = 1\n[time]\nend", 30, "reaction",
     "effects.reaction must be one table [effects.reaction], found the number 1"},
    {"[time]\nend", "[effects.reaction]\nrat = 1\n[time]\nend", 30, "rat",
     "unknown key \"rat\" in [effects.reaction]; did you mean \"rate\"?", "known keys: rate, half_life"},
    {"[time]\nend", "[effects.reaction]\n[time]\nend", 29, "[effects.reaction]",
     "[effects.reaction] has neither \"rate\" nor \"half_life\"", "give one of them: rate = 0.5, or half_life = 3"},
    {"[time]\nend", "[effects.reaction]\nrate = \"q*x\"\n[time]\nend", 30, "q",
     "unknown name \"q\"; known here: x, y, t, R, turn, pi, e"},
    {"[time]\nend", "[effects.diffusion]\n[time]\nend", 29, "[effects.diffusion]",
     "[effects.diffusion] has none of \"D\", \"D_axes\", \"D_field\", \"file\"",
     "give one of them: D = 0.01 is the same everywhere"},
    {"[time]\nend", "[effects.diffusion]\nD = -1\n[time]\nend", 30, "-1",
     "effects.diffusion.D must be greater than 0, found -1", "D: coefficient of diffusion, constant in space and time"},
    {"[time]\nend", "[effects.diffusion]\nD = 1\n[reference]\nkind = \"characteristics\"\n[time]\nend", 32,
     "\"characteristics\"", "with [effects.diffusion] the exact density cannot be traced along paths",
     "kind = \"exact\" and a formula as rho, or kind = \"none\""},
    {"[time]\nend", "[effects.diffusion]\nD = 1\ntolerance = 0.01\n[time]\nend", 31, "0.01",
     "\"tolerance\" goes with method = \"particle-exchange\""},
    {"[time]\nend", "[effects.remesh]\nevery = 5\nstretch = 2\n[time]\nend", 31, "stretch",
     "[effects.remesh] has both \"every\" and \"stretch\"",
     "every: number of steps from one remeshing to the next; stretch: remesh as soon as particles that were neighbours "
     "are farther apart than this many spacings h"},
    {"[time]\nend", "[effects.remesh]\nkernel = \"lambda45\"\n[time]\nend", 30, "\"lambda45\"",
     "unknown value \"lambda45\" for effects.remesh.kernel; did you mean \"lambda44\"?",
     "known values: \"gauss8\", \"lambda44\", \"lambda66\", \"m4prime\""},
    {"[time]\nend", "[effects.reaction]\nrate = [1]\n[time]\nend", 30, "[1]",
     "effects.reaction.rate must be an expression in a string, found a list"},
    {"overlap = 2", "overlap = 2\nstep = 0.1", 27, "step", "unknown key \"step\" in [particles]; it belongs in [time]",
     "known keys: per_axis, overlap, cutoff, width_ratio, threshold"},
    {"step = 0.001\n", "", 29, "[time]", "time.step is missing", step_note},
    {"per_axis = 300", "per_axes = 300", 25, "per_axes",
     "unknown key \"per_axes\" in [particles]; did you mean \"per_axis\"?",
     "known keys: per_axis, overlap, cutoff, width_ratio, threshold"},
    {"title = \"Rotating cone\"", "title = 3", 4, "3", "case.title must be a string, found the number 3"},
    {"title = \"Rotating cone\"", "title = 1979-05-27", 4, "1979-05-27",
     "case.title must be a string, found a date or time"},
    // params
    {"R = 0.25", "R = 0.25\nx = 1", 9, "x", "\"x\" cannot be a parameter's name: it is a coordinate", names_note},
    {"R = 0.25", "R = 0.25\nt = 1", 9, "t", "\"t\" cannot be a parameter's name: it is the time", names_note},
    {"R = 0.25", "R = 0.25\npi = 3", 9, "pi", "\"pi\" cannot be a parameter's name: it is a constant", names_note},
    {"R = 0.25", "R = 0.25\nsin = 3", 9, "sin", "\"sin\" cannot be a parameter's name: it is a function", names_note},
    {"R = 0.25", "R = 0.25\n\"a-b\" = 3", 9, "\"a-b\"",
     "\"a-b\" cannot be a parameter's name: at most 100 letters, digits and _, beginning with a letter or _",
     names_note},
    {"R = 0.25", "R = \"turn/8\"", 8, "turn", "\"turn\" is not defined yet; a parameter may use those before it",
     "params.R may be an expression of the params, pi and e"},
    {"R = 0.25", "R = \"2*R\"", 8, "R", "\"R\" is not defined yet; a parameter may use those before it",
     "params.R may be an expression of the params, pi and e"},
    {"R = 0.25", "R = \"x/4\"", 8, "x", "\"x\" has no value here: params.R is one number for the whole run",
     "params.R may be an expression of the params, pi and e"},
    {"R = 0.25", "R = true", 8, "true", "params.R must be a number or an expression, found true"},
    {"R = 0.25", "R = nan", 8, "nan", "params.R must be finite, found nan"},
    {"R = 0.25", "R = \"(0.25\"", 8, "(", "\"(\" is never closed",
     "params.R may be an expression of the params, pi and e"},
    {"R = 0.25", "R = \"\"", 8, "\"", "the expression is empty",
     "params.R may be an expression of the params, pi and e"},
    // domain
    {"min = [-1, -1]", "min = [-1]", 12, "[-1]", "domain.min needs 2 numbers (2D) or 3 numbers (3D), found 1"},
    {"min = [-1, -1]", "min = [-1, 1]", 13, "1", "the domain is empty along y: min = 1, max = 1",
     "min must be less than max on every axis"},
    {"max = [1, 1]", "max = [1, 1, 1]", 13, "[1, 1, 1]", "domain.min has 2 numbers, domain.max has 3",
     "2 numbers each in 2D, 3 in 3D"},
    {"max = [1, 1]", "max = [-2, 1]", 13, "-2", "the domain is empty along x: min = -1, max = -2",
     "min must be less than max on every axis"},
    {"max = [1, 1]", "max = [1, inf]", 13, "inf", "entry 2 of domain.max must be finite, found inf"},
    {"max = [1, 1]", "max = 1", 13, "1", "domain.max must be a list of numbers, found the number 1"},
    {"max = [1, 1]", "max = [1, [1]]", 13, "[1]",
     "entry 2 of domain.max must be a number or an expression, found a list"},
    // velocity
    {"u = [\"-y\", \"x\"]", "u = [\"-y\", \"x\", \"0\"]", 16, "[\"-y\", \"x\", \"0\"]",
     "velocity.u needs 2 expressions, one for each axis of the domain, found 3"},
    {"u = [\"-y\", \"x\"]", "u = \"-y\"", 16, "\"-y\"",
     "velocity.u must be a list of strings, one expression for each axis, found the string \"-y\""},
    {"u = [\"-y\", \"x\"]", "u = [\"-y\", true]", 16, "true",
     "entry 2 of velocity.u must be an expression in a string, found true"},
    {"u = [\"-y\", \"x\"]", "u = [\"-y\", \"x*z\"]", 16, "z", "z exists only in 3D; the domain has 2 dimensions"},
    {"u = [\"-y\", \"x\"]", "u = [\"-y\", \"x +\"]", 16, "+", "a value is missing after \"+\""},
    {"u = [\"-y\", \"x\"]", "u = [\"-y\", \"x\"]\nfield = \"rotation\"", 17, "field",
     "[velocity] has both \"u\" and \"field\"",
     "give exactly one of \"u\", \"streamfunction\", \"field\", \"file\", \"gaussians\", \"samples\""},
    {"u = [\"-y\", \"x\"]", "", 15, "[velocity]",
     "[velocity] has none of \"u\", \"streamfunction\", \"field\", \"file\", \"gaussians\", \"samples\"",
     "give exactly one of \"u\", \"streamfunction\", \"field\", \"file\", \"gaussians\", \"samples\""},
    {"u = [\"-y\", \"x\"]", "field = \"rotatoin\"", 16, "\"rotatoin\"",
     "unknown value \"rotatoin\" for velocity.field; did you mean \"rotation\"?",
     "known values: \"rotation\", \"translation\", \"shear\", \"strain\", \"swirl\", \"double_gyre\", "
     "\"taylor_green\", "
     "\"doswell\", \"lamb_oseen\", \"deformation\", \"abc\", \"burgers\", \"sphere_rotation\""},
    {"u = [\"-y\", \"x\"]", "u = [\"-y\", \"x\"]\nrate = 2", 17, "rate",
     "\"rate\" goes with field = \"rotation\" or \"shear\" or \"sphere_rotation\", not with \"u\"",
     "known keys with \"u\": u"},
    {"u = [\"-y\", \"x\"]", "field = \"rotation\"\ncenter = [0, 0, 0]", 17, "[0, 0, 0]",
     "velocity.center needs 2 numbers, one for each axis of the domain, found 3"},
    {"u = [\"-y\", \"x\"]", "u = [\"-y\", \"x\"]\npotential = \"x\"", 17, "potential",
     "unknown key \"potential\" in [velocity]", "known keys: u"},
    {"u = [\"-y\", \"x\"]", "field = \"strain\"", 15, "[velocity]", "velocity.rates is missing",
     "rates: rate of stretching along each axis"},
    {"u = [\"-y\", \"x\"]", "field = \"swirl\"\nperiod = 0", 17, "0", "velocity.period must be greater than 0, found 0",
     "period: the flow reverses at T/2 and has undone itself at T; without it the flow is steady"},
    {"u = [\"-y\", \"x\"]", "field = \"swirl\"\nrate = 1", 17, "rate",
     "\"rate\" goes with field = \"rotation\" or \"shear\" or \"sphere_rotation\", not with field = \"swirl\"",
     "known keys with field = \"swirl\": field, min, max, period"},
    {"u = [\"-y\", \"x\"]", "field = \"swirl\"\nperiode = 1", 17, "periode",
     "unknown key \"periode\" in [velocity]; did you mean \"period\"?", "known keys: field, min, max, period"},
    {"u = [\"-y\", \"x\"]", "field = \"swirl\"\nmax = [-1, 1]", 16, "\"swirl\"",
     "swirl: the box is empty along x: min must be less than max"},
    {"u = [\"-y\", \"x\"]", "field = \"burgers\"", 16, "\"burgers\"",
     "\"burgers\" exists only in 3D; the domain has 2 dimensions"},
    {"u = [\"-y\", \"x\"]", "streamfunction = \"x*z\"", 16, "z", "z exists only in 3D; the domain has 2 dimensions"},
    {"u = [\"-y\", \"x\"]", "streamfunction = \"x*\"", 16, "*", "a value is missing after \"*\""},
    {"u = [\"-y\", \"x\"]", "u = [1, 2]\narray = \"u\"", 17, "array", "\"array\" goes with \"file\", not with \"u\"",
     "known keys with \"u\": u"},
    // density
    {"shape = \"wendland\"", "shape = \"wendlnad\"", 19, "\"wendlnad\"",
     "unknown value \"wendlnad\" for density.shape; did you mean \"wendland\"?",
     "known values: \"wendland\", \"wendland4\", \"wendland6\", \"cone\", \"gaussian\", \"cosine_bell\", \"disk\", "
     "\"slotted_disk\", \"box\""},
    {"shape = \"wendland\"", "shape = \"wendland\"\nexpression = \"x\"", 20, "expression",
     "[density] has both \"shape\" and \"expression\"",
     "give exactly one of \"expression\", \"shape\", \"file\", \"samples\""},
    {"radius = \"R\"\n", "", 18, "[density]", "density.radius is missing", "radius: radius of the shape"},
    {"radius = \"R\"", "radius = \"R-R\"", 21, "\"R-R\"",
     "density.radius must be greater than 0, found 0 (from \"R-R\")", "radius: radius of the shape"},
    {"center = [0.5, 0]", "center = [0.5]", 20, "[0.5]",
     "density.center needs 2 numbers, one for each axis of the domain, found 1"},
    {"shape = \"wendland\"\ncenter = [0.5, 0]\nradius = \"R\"", "expression = \"R*x\"", 20, "height",
     "\"height\" goes with shape = \"wendland\" or \"wendland4\" or \"wendland6\" or \"cone\" or \"gaussian\" or "
     "\"cosine_bell\" or "
     "\"disk\" or \"slotted_disk\" or \"box\", not with \"expression\"",
     "known keys with \"expression\": expression, name, gain, half_life, diffusion, exact"},
    {"shape = \"wendland\"\ncenter = [0.5, 0]\nradius = \"R\"\nheight = 1.5", "expression = \"R*x*t\"", 19, "t",
     "the density at the start cannot depend on t"},
    // particles
    {"per_axis = 300", "per_axis = 1", 25, "1", "particles.per_axis must be at least 2, found 1",
     "per_axis: number of lattice points along the longest axis; one particle an axis has no spacing"},
    {"per_axis = 300", "per_axis = 30.5", 25, "30.5", "particles.per_axis must be a whole number, found 30.5",
     "per_axis: number of lattice points along the longest axis; one particle an axis has no spacing"},
    {"per_axis = 300", "per_axis = 1_000_000", 25, "1_000_000",
     "the particle lattice would have 1e+12 points (1000000 x 1000000); at most 2147483648 are possible",
     "lower per_axis"},
    {"per_axis = 300", "per_axis = \"1e12\"", 25, "\"1e12\"",
     "the particle lattice would have 1000000000000 points on one axis; at most 2147483647 are possible",
     "lower per_axis"},
    {"overlap = 2", "overlap = 2\nthreshold = 1", 27, "1",
     "particles.threshold must be at least 0 and at most 0.01, found 1",
     "threshold: lattice points that carry less than this part of the largest weight, and of the largest charge, get "
     "no particle"},
    {"overlap = 2", "overlap = 0", 26, "0", "particles.overlap must be at least 0.01 and at most 100, found 0",
     "overlap: core radius of a blob in units of the spacing: eps = c h"},
    {"overlap = 2", "overlap = 1e-300", 26, "1e-300",
     "particles.overlap must be at least 0.01 and at most 100, found 1e-300",
     "overlap: core radius of a blob in units of the spacing: eps = c h"},
    {"overlap = 2", "overlap = 1_000", 26, "1_000",
     "particles.overlap must be at least 0.01 and at most 100, found 1000",
     "overlap: core radius of a blob in units of the spacing: eps = c h"},
    {"cutoff = \"gauss2\"", "cutoff = \"gaus4\"", 27, "\"gaus4\"",
     "unknown value \"gaus4\" for particles.cutoff; did you mean \"gauss4\"?",
     "known values: \"gauss2\", \"gauss4\", \"gauss6\", \"gauss8\", \"two-gauss\""},
    {"cutoff = \"gauss2\"", "cutoff = 2", 27, "2", "particles.cutoff must be a string, found the number 2",
     "known values: \"gauss2\", \"gauss4\", \"gauss6\", \"gauss8\", \"two-gauss\""},
    // time
    {"end = \"turn\"", "end = inf", 30, "inf", "time.end must be finite, found inf"},
    {"step = 0.001", "step = 0", 31, "0", "time.step must be greater than 0, found 0", step_note},
    {"step = 0.001", "step = -0.001", 31, "-0.001", "time.step must be greater than 0, found -0.001", step_note},
    {"step = 0.001", "step = 1e-12", 31, "1e-12",
     "time.end / time.step is 6.28e+12 steps; at most 2147483648 are possible", "raise time.step"},
    {"method = \"rk4\"", "method = \"rk5\"", 32, "\"rk5\"",
     "unknown value \"rk5\" for time.method; did you mean \"rk4\"?",
     "known values: \"rk4\", \"euler\", \"heun\", \"rk4-38\", \"dopri5\""},
    // evaluate
    {"tolerance = 1e-8", "tolerance = 1", 36, "1", "evaluate.tolerance must be at least 1e-14 and less than 1, found 1",
     "tolerance: error allowed in the Gauss transform, relative to the largest density at that output"},
    {"tolerance = 1e-8", "tolerance = 1e-15", 36, "1e-15",
     "evaluate.tolerance must be at least 1e-14 and less than 1, found 1e-15",
     "tolerance: error allowed in the Gauss transform, relative to the largest density at that output"},
    {"per_axis = 200", "per_axis = 2_000_000", 35, "2_000_000",
     "the evaluation lattice would have 4e+12 points (2000000 x 2000000); at most 1099511627776 are possible",
     "lower per_axis"},
    {"method = \"auto\"", "method = \"hermit\"", 37, "\"hermit\"",
     "unknown value \"hermit\" for evaluate.method; did you mean \"hermite\"?",
     "known values: \"auto\", \"direct\", \"hermite\", \"cells\", \"outer\", \"chebyshev\", \"spread\""},
    {"method = \"auto\"", "r = 0.4", 37, "r", "evaluate.r, p and n go with method = \"hermite\", not with \"auto\"",
     "write method = \"hermite\", or leave them out: a tolerance is enough"},
    {"method = \"auto\"", "method = \"hermite\"\nr = 1", 38, "1",
     "evaluate.r must be greater than 0 and less than 1, found 1",
     "r: for method = \"hermite\", by hand: boxes have the side r sqrt(2/sigma)"},
    // output
    {"\"turn/4\", \"turn\"]", "\"turn/4\", 7]", 40, "7",
     "entry 3 of output.times is 7, after time.end = 6.283185307179586"},
    {"times = [0,", "times = [-1,", 40, "-1", "entry 1 of output.times is -1; the run begins at 0"},
    {"times = [0, \"turn/4\", \"turn\"]", "times = [2, 1]", 40, "1",
     "entry 2 of output.times is 1, not after the entry before it, 2", "output.times must ascend"},
    {"times = [0, \"turn/4\", \"turn\"]", "times = [1, 1]", 40, "1",
     "entry 2 of output.times is 1, not after the entry before it, 1", "output.times must ascend"},
    {"times = [0, \"turn/4\", \"turn\"]", "times = []", 40, "[]", "output.times is empty; give at least one time",
     "output.frames = 5 spreads 5 times evenly"},
    {"times = [0, \"turn/4\", \"turn\"]", "times = [0]\nframes = 3", 41, "frames",
     "[output] has both \"times\" and \"frames\"", "give exactly one of \"times\", \"frames\""},
    {"times = [0, \"turn/4\", \"turn\"]", "frames = 0", 40, "0",
     "output.frames must be at least 1 and at most 1000000, found 0",
     "frames: number of outputs, evenly spaced from time.start to time.end; 1 means the end alone"},
    {"vtk = [\"density\", \"particles\"]", "vtk = [\"density\", \"denstiy\"]", 41, "\"denstiy\"",
     "unknown value \"denstiy\" for entry 2 of output.vtk; did you mean \"density\"?",
     "known values: \"density\", \"particles\""},
    {"vtk = [\"density\", \"particles\"]", "vtk = [\"density\", \"density\"]", 41, "\"density\"",
     "\"density\" appears twice in output.vtk"},
    {"images = [\"surface\"]", "images = \"surface\"", 42, "\"surface\"",
     "output.images must be a list of some of \"surface\", \"contour\", \"heatmap\", \"arrows\", \"streamlines\", "
     "\"slices\", \"projection\", "
     "\"isosurface\", \"error\", found the string \"surface\""},
    {"images = [\"surface\"]", "images = [\"colour\"]", 42, "\"colour\"",
     "unknown value \"colour\" for entry 1 of output.images; did you mean \"contour\"?",
     "known values: \"surface\", \"contour\", \"heatmap\", \"arrows\", \"streamlines\", \"slices\", \"projection\", "
     "\"isosurface\", \"error\""},
    {"images = [\"surface\"]", "images = [\"surface\", \"slices\"]", 42, "\"slices\"",
     "\"slices\" shows scenes in 3D; the domain has 2 dimensions",
     "pictures in 2D: \"surface\", \"contour\", \"heatmap\", \"arrows\", \"streamlines\", \"error\""},
};

TEST(CaseFile, RefusesEachWrongInputWithPlaceRuleAndRemedy) {
  ASSERT_EQ(errors(cone), "");
  for (const Wrong& wrong : wrongs) {
    const std::string text = with(cone, wrong.old_part, wrong.new_part);
    EXPECT_EQ(errors(text), expected(text, wrong));
  }
}

TEST(CaseFile, RefusesAVelocityThatIsNoTable) {
  const std::string text =
      with(with(cone, "[velocity]\nu = [\"-y\", \"x\"]", ""), "gaussdrift = 1", "gaussdrift = 1\nvelocity = []");
  EXPECT_EQ(errors(text),
            R"text(error: velocity must be a table [velocity], or several tables [[velocity]], found a list
 --> cone.toml:2:1
  |
2 | velocity = []
  | ^^^^^^^^

1 error in cone.toml)text");
}

TEST(CaseFile, RefusesPicturesOfTheOtherDimension) {
  EXPECT_EQ(errors(least + "[output]\nimages = [\"slices\", \"contour\"]\n"),
            R"text(error: "contour" shows scenes in 2D; the domain has 3 dimensions
  --> cone.toml:15:21
   |
15 | images = ["slices", "contour"]
   |                     ^^^^^^^^^
   = pictures in 3D: "slices", "projection", "isosurface", "error"

1 error in cone.toml)text");
  EXPECT_EQ(errors(least + "[output]\nimages = []\n"), "");
}

/// A table that follows the cone's, and the message about it.
struct WrongEnd {
  std::string tables, message;
};

TEST(CaseFile, RefusesAReferenceThatContradictsItself) {
  for (const WrongEnd& wrong : std::vector<WrongEnd>{
           {"[reference]\nkind = \"exact\"\n", "kind = \"exact\" needs the exact density as \"rho\""},
           {"[reference]\nrho = \"x\"\n", "\"rho\" goes with kind = \"exact\", not with \"characteristics\""},
           {"[reference]\nkind = \"none\"\nrho = \"x\"\n", "\"rho\" goes with kind = \"exact\", not with \"none\""},
           {"[reference]\nkind = \"exact\"\nrho = \"x +\"\n", "--> cone.toml:45:"},
           {"[reference]\nkind = \"exact\"\nrho = \"z\"\n", "z exists only in 3D; the domain has 2 dimensions"},
           {"[reference]\nkind = \"characteristic\"\n", "did you mean \"characteristics\"?"},
           {"[reference]\npoints = 8\n", "reference.points must be at least 16"},
           {"[reference]\nkind = \"none\"\npoints = 100\n",
            "\"points\" has no meaning where reference.kind is \"none\""},
           {"[accuracy]\ntarget = 1\n", "accuracy.target must be at least 1e-09 and at most 0.5"},
           {"[accuracy]\nbudget = \"all\"\n", "unknown value \"all\" for accuracy.budget"},
           {"[effects.diffusion]\nD = 1\n[accuracy]\ntarget = 0.1\n",
            "no settings can be chosen for a target with [effects.diffusion]"},
           {"[reference]\nmethod = 1\n", "unknown key \"method\" in [reference]; it belongs in [time] or [evaluate]"}})
    EXPECT_NE(errors(cone + wrong.tables).find(wrong.message), std::string::npos) << errors(cone + wrong.tables);
  const std::string pictures = with(cone, "images = [\"surface\"]", "images = [\"error\"]");
  EXPECT_EQ(errors(pictures), "");
  EXPECT_NE(errors(pictures + "[reference]\nkind = \"none\"\n")
                .find("the picture \"error\" needs an exact density, but reference.kind is \"none\""),
            std::string::npos);
  EXPECT_NE(errors(pictures + "[reference]\npoints = 100\n")
                .find("the picture \"error\" needs the whole grid, but reference.points takes a sample"),
            std::string::npos);
}

TEST(CaseFile, RefusesChecksThatCannotBeJudged) {
  for (const WrongEnd& wrong : std::vector<WrongEnd>{
           {"[[check]]\nmax = 1\n", "[check] has none of \"what\""},
           {"[[check]]\nwhat = \"L3\"\nmax = 1\n", "unknown value \"L3\" for check.what"},
           {"[[check]]\nwhat = \"L2\"\n", "a check needs \"max\" or \"min\", or both"},
           {"[[check]]\nwhat = \"L2\"\nmax = 1\nmin = 2\n", "no number is at least 2 and at most 1"},
           {"[[check]]\nwhat = \"L2\"\nmaximum = 1\n", "unknown key \"maximum\" in [check]"},
           {"[[check]]\nwhat = \"L2\"\nmax = 1\nat = 0.1\n", "check.at = 0.1 is none of the output times"},
           {"[[check]]\nwhat = \"L2\"\nmax = 1\n[reference]\nkind = \"none\"\n",
            "L2 needs an exact density, but reference.kind is \"none\""}})
    EXPECT_NE(errors(cone + wrong.tables).find(wrong.message), std::string::npos) << errors(cone + wrong.tables);
  EXPECT_EQ(errors(cone + "[[check]]\nwhat = \"mass\"\nmin = 1\n[reference]\nkind = \"none\"\n"), "");
}

TEST(CaseFile, RefusesALatticeThatRoundingWouldSwallow) {
  const std::string text =
      with(with(cone, "min = [-1, -1]", "min = [1e16, -1]"), "max = [1, 1]", "max = [\"1e16+4\", 1]");
  EXPECT_NE(errors(text).find("is lost to rounding at coordinates like 1.0000000000000004e+16"), std::string::npos)
      << errors(text);
}

TEST(CaseFile, DoesNotComplainAgainAboutWhatFollowsFromAnError) {
  const std::string text = with(cone, "R = 0.25", "R = \"1/0\"");
  EXPECT_NE(errors(text).find("\n1 error in cone.toml"), std::string::npos) << errors(text);
}

TEST(CaseFile, NamesItsExitCodeAndItsCount) {
  try {
    parse_case(with(with(cone, "overlap = 2", "overlap = 0"), "per_axis = 300", "per_axis = 1"), "cone.toml");
    FAIL() << "taken";
  } catch (const CaseError& error) {
    EXPECT_EQ(error.count(), 2);
    EXPECT_EQ(error.code(), ExitCode::input);
  }
}

TEST(CaseFile, SaysWhyItCannotBeRead) {
  const std::string folder = BINARY_DIR;
  EXPECT_THROW(read_case(folder + "/no-such-case.toml"), FileError);
  try {
    read_case(folder);
    FAIL() << "a folder was read";
  } catch (const FileError& error) {
    EXPECT_EQ(error.what(), folder + " is a folder, not a case file");
  }
}

TEST(Overrides, AreRefusedLikeTheFile) {
  const struct {
    const char *text, *message;
  } refusals[] = {
      {"time.step",
       "error: an override needs a value\n  --> --set time.step\n            ^^^^^^^^^\n   = write --set "
       "table.key=value, for example --set time.step=0.01\n"},
      {"time.step=", "error: no value for \"time.step\"\n  --> --set time.step=\n                      ^\n"},
      {"tim.step=1", "error: unknown table [tim]; did you mean [time]?\n  --> --set tim.step=1\n            ^^^\n"},
      {"time.stpe=1",
       "error: unknown key \"stpe\" in [time]; did you mean \"step\"?\n  --> --set time.stpe=1\n            "
       "^^^^^^^^^\n   = known keys: start, end, step, method, tolerance\n"},
      {"step=1",
       "error: unknown key \"step\" at the top of the file; it belongs in [time]\n  --> --set step=1\n            "
       "^^^^\n"},
      {"particles.cutoff=gauss5",
       "error: unknown value \"gauss5\" for particles.cutoff; did you mean \"gauss2\"?\n  --> --set "
       "particles.cutoff=gauss5\n                             ^^^^^^\n"},
      {"output.times=[0,\"pii\"]",
       "error: unknown name \"pii\"; did you mean \"pi\"?\n  --> --set output.times=[0,\"pii\"]\n                      "
       "       ^^^\n"},
      {"time.end=2*pii",
       "error: unknown name \"pii\"; did you mean \"pi\"?\n  --> --set time.end=2*pii\n                       ^^^\n"},
      {"output.times=[0,", "error: cannot read this array: "},
      {"domain.min.x=1",
       "error: \"domain.min\" is a list and has no keys of its own\n  --> --set domain.min.x=1\n            "
       "^^^^^^^^^^^^\n"},
      {"velocity.field=rotation",
       "error: [velocity] has both \"u\" and \"field\"\n  --> --set velocity.field=rotation\n            "
       "^^^^^^^^^^^^^^\n"},
      {"=3", "error: unknown key \"\" at the top of the file"},
  };
  for (const auto& refusal : refusals)
    EXPECT_EQ(errors(cone, {refusal.text}).substr(0, std::string(refusal.message).size()), refusal.message);
}

TEST(CaseFile, RefusesAStreamfunctionIn3D) {
  const std::string found = errors(with(least, "u = [\"y\", \"z*t\", \"x\"]", "streamfunction = \"x\""));
  EXPECT_NE(found.find("velocity.streamfunction exists only in 2D; the domain has 3 dimensions"), std::string::npos);
}

TEST(Warnings, SayWhereAStreamfunctionHasNoDerivative) {
  const auto warnings =
      parse_case(with(cone, "u = [\"-y\", \"x\"]", "streamfunction = \"x*y + abs(x)\""), "cone.toml").warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(
      warnings[0],
      R"text(warning: the streamfunction has no derivative everywhere: abs has a corner at 0, where slope 0 is taken
  --> cone.toml:16:25
   |
16 | streamfunction = "x*y + abs(x)"
   |                         ^^^
   = the velocity is its derivative; it is right where particles do not meet such a place)text");
}

TEST(Warnings, NameUnusedParamsAndSmallOverlap) {
  std::string text = with(cone, "R = 0.25", "R = 0.25\nunused = 3");
  text = with(text, "overlap = 2", "overlap = 0.8");
  const auto warnings = parse_case(text, "cone.toml").warnings;
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_EQ(warnings[0], R"text(warning: the parameter "unused" is not used
 --> cone.toml:9:1
  |
9 | unused = 3
  | ^^^^^^
  = no expression of the case mentions it)text");
  EXPECT_EQ(warnings[1],
            R"text(warning: overlap = 0.8 leaves gaps between the blobs: a constant density ripples by 0.007
  --> cone.toml:27:11
   |
27 | overlap = 0.8
   |           ^^^
   = 2 is usual; 1 ripples by about 2e-4)text");
}

TEST(Warnings, NameADomainOneParticleThin) {
  const auto warnings = parse_case(with(cone, "max = [1, 1]", "max = [1, -0.999]"), "cone.toml").warnings;
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("the domain is narrower along y than the spacing 0.00669: one particle across"),
            std::string::npos)
      << warnings[0];
}

}  // namespace
}  // namespace gaussdrift::input
