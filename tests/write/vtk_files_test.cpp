// The files as others read them: with VTK's readers from Python, which is what ParaView's scripts use.
#include "write/vtk_files.hpp"
#include "write/python_with_vtk.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <vector>

#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "particle/subset.hpp"
#include "scratch_folder.hpp"
#include "write/atomic_file.hpp"
#include "write/disk.hpp"
#include "write/output_files.hpp"
#include "write/vtk_array.hpp"

namespace gaussdrift::write {
namespace {

template <class Value>
std::string numbers(const std::vector<Value>& values) {
  std::string text;
  for (const Value value : values) {
    std::array<char, 40> digits{};
    if constexpr (std::is_floating_point_v<Value>)
      std::snprintf(digits.data(), digits.size(), " %.17g", value);
    else
      std::snprintf(digits.data(), digits.size(), " %lld", static_cast<long long>(value));
    text += digits.data();
  }
  return text;
}

/// Values without a short decimal form, of very different sizes.
double awkward(std::size_t i) {
  return std::sin(1. + static_cast<double>(i)) * std::pow(10., static_cast<double>(i % 7) - 3);
}

DensityGrid some_density(int dimension, const Vector& min, const Vector& max, int per_axis) {
  DensityGrid density{make_lattice(dimension, min, max, per_axis), {}};
  for (std::size_t i = 0; i < density.lattice.size(); ++i) density.rho.push_back(awkward(i));
  return density;
}

Particles some_particles(int dimension, std::size_t count) {
  Particles particles;
  particles.dimension = dimension;
  for (std::size_t j = 0; j < count; ++j) {
    for (int k = 0; k < dimension; ++k) particles.position[k].push_back(awkward(10 * j + static_cast<std::size_t>(k)));
    particles.alpha.push_back(awkward(j) / 3);
    particles.id.push_back(std::int64_t{5'000'000'000} + static_cast<std::int64_t>(j));  // needs 64 bits
  }
  return particles;
}

std::vector<double> some_velocity(const Particles& particles) {
  std::vector<double> velocity;
  for (std::size_t i = 0; i < particles.size() * static_cast<std::size_t>(particles.dimension); ++i)
    velocity.push_back(awkward(3 * i + 1));
  return velocity;
}

TEST(DensityFile, IsReadByParaViewsReaderDigitByDigit) {
  const std::string python = python_with_vtk();
  if (python.empty()) GTEST_SKIP() << "no Python with VTK (Debian: python3-vtk9)";
  const ScratchFolder folder;
  // A lattice that is not square, far from the origin, with spacing 1/3.
  const auto density = some_density(2, {1e6 + 1 / 7., -2, 0}, {1e6 + 1 / 7. + 2, -1, 0}, 7);
  Collection series(folder / "density.pvd");
  std::string expected;
  const std::vector<double> times{0, std::numbers::pi / 2, 2 * std::numbers::pi};
  for (std::size_t i = 0; i < times.size(); ++i) {
    const std::string name = "density/density_000" + std::to_string(i) + ".vti";
    auto frame = density;
    frame.rho[3] = times[i];
    write_density(folder / name, frame, times[i]);
    series.add(times[i], folder / name);
    const auto& lattice = frame.lattice;
    expected += "timestep" + numbers<double>({times[i]}) + " " + name + "\nvtkImageData\n";
    expected += "extent" + numbers<long>({0, 6, 0, 3, 0, 0}) + "\n";
    expected += "origin" + numbers<double>({lattice.origin[0], lattice.origin[1], 0}) + "\n";
    expected += "spacing" + numbers<double>({lattice.spacing, lattice.spacing, lattice.spacing}) + "\n";
    expected += "scalars rho\narray rho double 1" + numbers(frame.rho) + "\n";
    expected += "field TimeValue double 1" + numbers<double>({times[i]}) + "\n";
    EXPECT_EQ(read_series(python, folder / "density.pvd"), expected);  // valid after every frame
  }
}

TEST(DensityFile, OfThreeDimensionsIsReadBack) {
  const std::string python = python_with_vtk();
  if (python.empty()) GTEST_SKIP() << "no Python with VTK (Debian: python3-vtk9)";
  const ScratchFolder folder;
  const auto density = some_density(3, {0, 0, 0}, {1, 0.5, 0.75}, 5);
  write_density(folder / "rho.vti", density, -1.5);
  Collection(folder / "rho.pvd").add(-1.5, folder / "rho.vti");
  const std::string text = read_series(python, folder / "rho.pvd");
  EXPECT_NE(text.find("extent 0 4 0 2 0 3\n"), std::string::npos) << text;
  EXPECT_NE(text.find("array rho double 1" + numbers(density.rho) + "\n"), std::string::npos) << text;
}

TEST(DensityFile, InPiecesIsReadAsOne) {
  const std::string python = python_with_vtk();
  if (python.empty()) GTEST_SKIP() << "no Python with VTK (Debian: python3-vtk9)";
  for (const int dimension : {2, 3}) {
    const ScratchFolder folder;
    const auto density = some_density(dimension, {1e6 + 1 / 7., -2, 0}, {1e6 + 1 / 7. + 2, -1, 0.5}, 21);
    const Lattice& lattice = density.lattice;
    const LatticePieces pieces(lattice, dimension == 2 ? 50 : 300);
    ASSERT_GT(pieces.count(), 3u);
    Frame frame;
    frame.index = 12, frame.time = 1 / 3.;
    frame.density = &density;
    frame.pieces = &pieces, frame.lattice = &lattice, frame.pieces_have_exact = dimension == 3;
    frame.piece_fields = {{"laplacian", 1}, {"gradient", 2}};
    std::vector<double> all_exact, triples;
    for (const double value : density.rho)
      for (const double factor : {2., -1., 0.}) triples.push_back(factor == 0 ? 0 : factor * value);
    for (const double value : density.rho) all_exact.push_back(0.9 * value);
    const auto series = file_series(find_output_file("density"), folder.path());
    for (std::size_t number = 0; number < pieces.count(); ++number) {
      const LatticeBox box = pieces.shown(number);
      std::vector<double> rho, exact;
      for (std::size_t l = box.first[2]; l < box.end(2); ++l)
        for (std::size_t j = box.first[1]; j < box.end(1); ++j)
          for (std::size_t i = box.first[0]; i < box.end(0); ++i) {
            const std::size_t point = i + lattice.points[0] * (j + lattice.points[1] * l);
            rho.push_back(density.rho[point]), exact.push_back(all_exact[point]);
          }
      std::vector<double> pairs;
      for (const double value : rho) pairs.push_back(2 * value), pairs.push_back(-value);
      const std::vector<FieldOnGrid> fields{{"laplacian", 1, rho}, {"gradient", 2, pairs}};
      series->piece(frame, {number, box, &rho, frame.pieces_have_exact ? &exact : nullptr, &fields});
    }
    series->frame(frame);
    const std::string text = read_series(python, folder / "density.pvd");
    EXPECT_NE(text.find(" density/density_0012.pvti\nvtkImageData\n"), std::string::npos) << text.substr(0, 500);
    EXPECT_NE(text.find("origin" + numbers<double>({lattice.origin[0], lattice.origin[1], lattice.origin[2]}) + "\n"),
              std::string::npos)
        << text.substr(0, 500);
    EXPECT_NE(text.find("array rho double 1" + numbers(density.rho) + "\n"), std::string::npos);
    EXPECT_NE(text.find("array laplacian double 1" + numbers(density.rho) + "\n"), std::string::npos);
    EXPECT_NE(text.find("array gradient double 3" + numbers(triples) + "\n"), std::string::npos);
    EXPECT_EQ(text.find("array rho_exact double 1" + numbers(all_exact) + "\n") != std::string::npos,
              frame.pieces_have_exact);
  }
}

TEST(DensityFile, HasTheExactDensityAndTheErrorBesideIt) {
  const std::string python = python_with_vtk();
  if (python.empty()) GTEST_SKIP() << "no Python with VTK (Debian: python3-vtk9)";
  const ScratchFolder folder;
  auto density = some_density(2, {0, 0, 0}, {1, 0.5, 0}, 5);
  std::vector<double> pairs, triples;
  for (const double value : density.rho) {
    for (const double component : {value, 3 * value}) pairs.push_back(component), triples.push_back(component);
    triples.push_back(0);
  }
  density.fields = {{"velocity", 2, pairs}, {"stretch", 1, density.rho}};
  std::vector<double> exact, error;
  for (const double value : density.rho) {
    exact.push_back(0.9 * value);
    error.push_back(value - exact.back());
  }
  write_density(folder / "rho.vti", density, 0, &exact);
  Collection(folder / "rho.pvd").add(0, folder / "rho.vti");
  const std::string text = read_series(python, folder / "rho.pvd");
  EXPECT_NE(text.find("scalars rho\n"), std::string::npos) << "what ParaView shows first";
  EXPECT_NE(text.find("array rho double 1" + numbers(density.rho) + "\n"), std::string::npos) << text;
  EXPECT_NE(text.find("array rho_exact double 1" + numbers(exact) + "\n"), std::string::npos) << text;
  EXPECT_NE(text.find("array error double 1" + numbers(error) + "\n"), std::string::npos) << text;
  EXPECT_NE(text.find("array velocity double 3" + numbers(triples) + "\n"), std::string::npos) << text;
  EXPECT_NE(text.find("array stretch double 1" + numbers(density.rho) + "\n"), std::string::npos) << text;
  exact.pop_back();
  EXPECT_THROW(write_density(folder / "rho.vti", density, 0, &exact), Error);
}

TEST(ParticleFile, IsReadByParaViewsReaderDigitByDigit) {
  const std::string python = python_with_vtk();
  if (python.empty()) GTEST_SKIP() << "no Python with VTK (Debian: python3-vtk9)";
  for (const int dimension : {2, 3}) {
    const ScratchFolder folder;
    const auto particles = some_particles(dimension, 11);
    const auto velocity = some_velocity(particles);
    write_particles(folder / "particles_0000.vtp", particles, velocity, 0.1);
    Collection(folder / "particles.pvd").add(0.1, folder / "particles_0000.vtp");

    std::vector<double> points, u;  // padded with zeros
    std::vector<long> vertices;
    for (std::size_t j = 0; j < particles.size(); ++j) {
      for (int k = 0; k < 3; ++k) {
        points.push_back(k < dimension ? particles.position[k][j] : 0);
        u.push_back(k < dimension ? velocity[j * static_cast<std::size_t>(dimension) + static_cast<std::size_t>(k)]
                                  : 0);
      }
      vertices.push_back(static_cast<long>(j));
    }
    const std::string text = read_series(python, folder / "particles.pvd");
    const std::string type_of_id = text.find("array id long long 1") != std::string::npos ? "long long" : "long";
    EXPECT_EQ(text, "timestep" + numbers<double>({0.1}) + " particles_0000.vtp\nvtkPolyData\npoints double" +
                        numbers(points) + "\nvertices" + numbers(vertices) + "\nsingle True\nscalars alpha\narray id " +
                        type_of_id + " 1" + numbers(particles.id) + "\narray alpha double 1" +
                        numbers(particles.alpha) + "\narray u double 3" + numbers(u) + "\nfield TimeValue double 1" +
                        numbers<double>({0.1}) + "\n");
    EXPECT_NE(read_file(folder / "particles_0000.vtp").find("type=\"Int64\" Name=\"id\""), std::string::npos);
  }
}

TEST(ParticleFile, InPiecesIsReadAsOne) {
  const std::string python = python_with_vtk();
  if (python.empty()) GTEST_SKIP() << "no Python with VTK (Debian: python3-vtk9)";
  for (const int dimension : {2, 3}) {
    const ScratchFolder folder;
    const auto particles = some_particles(dimension, 11);
    const auto velocity = some_velocity(particles);
    const DensityGrid none;
    Frame frame;
    frame.index = 3, frame.time = 0.1;
    frame.particles = &particles, frame.velocity = &velocity, frame.density = &none;
    const auto whole = file_series(find_output_file("particles"), folder / "whole");
    whole->frame(frame);
    frame.particle_pieces = 3;
    const auto series = file_series(find_output_file("particles"), folder / "pieces");
    const std::size_t first[] = {0, 4, 8, particles.size()};
    for (std::size_t number = 0; number < 3; ++number) {
      std::vector<std::size_t> chosen;
      std::vector<double> of_piece;
      for (std::size_t j = first[number]; j < first[number + 1]; ++j) {
        chosen.push_back(j);
        for (int k = 0; k < dimension; ++k)
          of_piece.push_back(velocity[j * static_cast<std::size_t>(dimension) + static_cast<std::size_t>(k)]);
      }
      const Particles piece = subset(particles, chosen);
      series->particle_piece(frame, {number, &piece, &of_piece});
    }
    series->frame(frame);
    std::string one = read_series(python, folder / "whole/particles.pvd"),
                all = read_series(python, folder / "pieces/particles.pvd");
    EXPECT_NE(all.find(" particles/particles_0003.pvtp\nvtkPolyData\n"), std::string::npos) << all.substr(0, 500);
    one.erase(0, one.find('\n')), all.erase(0, all.find('\n'));
    EXPECT_EQ(all.substr(0, all.find("field ")), one.substr(0, one.find("field ")));
  }
}

TEST(ParticleFile, WithoutParticlesIsStillAFile) {
  const std::string python = python_with_vtk();
  if (python.empty()) GTEST_SKIP() << "no Python with VTK (Debian: python3-vtk9)";
  const ScratchFolder folder;
  write_particles(folder / "none.vtp", Particles{}, {}, 1);
  Collection(folder / "none.pvd").add(1, folder / "none.vtp");
  const std::string text = read_series(python, folder / "none.pvd");
  EXPECT_NE(text.find("array u double 3 \n"), std::string::npos) << text;
  EXPECT_NE(text.find("field TimeValue double 1 1\n"), std::string::npos) << text;
}

TEST(VtkFiles, AreWellFormedXmlThroughout) {
  // Readers whose parser looks behind <AppendedData> stumble over what follows there: nothing must.
  const ScratchFolder folder;
  write_density(folder / "rho.vti", some_density(2, {0, 0, 0}, {1, 1, 0}, 20), 0);
  const std::string text = read_file(folder / "rho.vti");
  for (const char* part : {"format=\"binary\"", "header_type=\"UInt64\"", "type=\"Float64\" Name=\"rho\"", "TimeValue"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_EQ(text.find("AppendedData"), std::string::npos);
  EXPECT_EQ(text.find("compressor"), std::string::npos);
  EXPECT_TRUE(
      std::all_of(text.begin(), text.end(), [](unsigned char c) { return c == '\n' || (c >= ' ' && c < 127); }));
}

TEST(VtkFiles, HaveTheLettersOfVtksOwnWriter) {
  const std::string python = python_with_vtk();
  if (python.empty()) GTEST_SKIP() << "no Python with VTK (Debian: python3-vtk9)";
  const ScratchFolder folder;
  // Blocks of 3072 numbers are encoded at once: 3071 of them stand behind the length.
  for (const std::size_t count : {0u, 1u, 2u, 3u, 1024u, 3071u, 3072u, 3073u}) {
    const auto particles = some_particles(count % 2 == 0 ? 2 : 3, count);
    write_particles(folder / (std::to_string(count) + ".vtp"), particles, some_velocity(particles), awkward(count));
  }
  auto density = some_density(2, {1e6 + 1 / 7., -2e-9, 0}, {1e6 + 1 / 7. + 2, 1, 0}, 40);
  write_density(folder / "rho.vti", density, -1e22);
  std::vector<double> exact(density.rho.size(), 1 / 3.);
  exact[3] = exact[500] = std::nan("");
  density.rho[7] = 1e-320, density.rho[8] = 1e21, density.rho[9] = -0.;
  write_density(folder / "error.vti", density, 1e-7, &exact);
  std::vector<double> pairs;
  for (const double value : density.rho) pairs.push_back(value), pairs.push_back(-value / 3);
  density.fields = {{"velocity", 2, pairs}, {"stretch", 1, density.rho}};
  write_density(folder / "fields.vti", density, 1);
  write_text(folder / "alone.vti", fields_text("alone.vti", density.lattice, density.fields, 1));
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    const std::string vtk =
        output_of(python + " " SOURCE_DIR "/tests/write/written_by_vtk.py '" + entry.path().string() + "' 2>&1");
    EXPECT_TRUE(read_file(entry.path()) == vtk) << entry.path().filename() << "\n" << vtk.substr(0, 1500);
  }
}

TEST(VtkArray, NumbersHaveTheShortestTextThatGivesThemBack) {
  for (const auto& [value, text] : {std::pair{0.1, "0.1"},
                                    {-0., "0"},
                                    {-2.5, "-2.5"},
                                    {1e20, "100000000000000000000"},
                                    {1e21, "1e+21"},
                                    {-1.5e300, "-1.5e+300"},
                                    {5e-324, "5e-324"},
                                    {1e-6, "0.000001"},
                                    {1.25e-7, "1.25e-7"},
                                    {1 / 3., "0.3333333333333333"},
                                    {123456789.0, "123456789"},
                                    {9007199254740993.0, "9007199254740992"},
                                    {static_cast<double>(INFINITY), "Infinity"},
                                    {-static_cast<double>(INFINITY), "-Infinity"},
                                    {std::nan(""), "NaN"}})
    EXPECT_EQ(shortest_text(value), text);
}

TEST(VtkFiles, RefuseArraysOfTheWrongLength) {
  const ScratchFolder folder;
  auto density = some_density(2, {0, 0, 0}, {1, 1, 0}, 5);
  density.rho.pop_back();
  EXPECT_THROW(write_density(folder / "rho.vti", density, 0), Error);
  EXPECT_THROW(write_particles(folder / "p.vtp", some_particles(2, 3), {1, 2, 3}, 0), Error);
  EXPECT_EQ(folder.count(), 0u);
}

/// Sizes below and above the buffer of a stream, where a failure shows at different calls.
TEST(VtkFiles, KeepTheOldFileWhenTheLimitOfFileSizesIsMet) {
  for (const int per_axis : {5, 20, 300}) {
    const ScratchFolder folder;
    const auto density = some_density(2, {0, 0, 0}, {1, 1, 0}, per_axis);
    write_density(folder / "rho.vti", density, 0);
    const std::string old = read_file(folder / "rho.vti");
    for (const std::size_t missing : {old.size() - 200, old.size() / 2, std::size_t{1}}) {
      std::string text;
      {
        const FileSizeLimit limit(old.size() - missing);
        text = message_of<FileError>([&] { write_density(folder / "rho.vti", density, 0); });
      }
      EXPECT_NE(text.find("cannot write " + (folder / "rho.vti").string() + ": "), std::string::npos)
          << per_axis << " " << missing << text;
      EXPECT_NE(text.find("free some space"), std::string::npos) << text;
      EXPECT_EQ(read_file(folder / "rho.vti"), old);
      EXPECT_EQ(folder.count(), 1u) << "something was left beside it";
    }
  }
}

TEST(VtkFiles, NameFileReasonAndRemedyOnAFullDisk) {
  const ScratchFolder folder;
  const SmallDisk disk(folder.path());
  if (!disk.mounted()) GTEST_SKIP() << "this user may not mount a small file system";
  const auto small = some_density(2, {0, 0, 0}, {1, 1, 0}, 5), large = some_density(2, {0, 0, 0}, {1, 1, 0}, 200);
  write_density(folder / "density_0002.vti", small, 0);
  const std::string old = read_file(folder / "density_0002.vti");
  for (const char* name : {"density_0002.vti", "density_0003.vti"}) {
    const auto text = message_of<FileError>([&] { write_density(folder / name, large, 1); });
    EXPECT_EQ(text, "cannot write " + (folder / name).string() +
                        ": No space left on device (28); free some space, or choose another folder with --out; "
                        "everything written before is intact");
  }
  const auto particles = some_particles(2, 5000);
  EXPECT_THROW(write_particles(folder / "particles_0003.vtp", particles, some_velocity(particles), 1), FileError);
  EXPECT_EQ(read_file(folder / "density_0002.vti"), old);
  EXPECT_EQ(folder.count(), 1u);
}

TEST(VtkFiles, SayNothingOnTheTerminalWhenTheyFail) {
  const ScratchFolder folder;
  const auto density = some_density(2, {0, 0, 0}, {1, 1, 0}, 300);
  testing::internal::CaptureStderr();
  {
    const FileSizeLimit limit(10000);
    EXPECT_THROW(write_density(folder / "rho.vti", density, 0), FileError);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Collection, WritesPathsRelativeToItselfAndEscapesThem) {
  const ScratchFolder folder;
  Collection series(folder / "run/density.pvd");
  series.add(1. / 3, folder / "run/density/a<b & \"c\".vti");
  series.add(2, folder / "elsewhere/b.vti");
  const std::string text = read_file(folder / "run/density.pvd");
  EXPECT_NE(text.find("timestep=\"0.33333333333333331\" part=\"0\" file=\"density/a&lt;b &amp; &quot;c&quot;.vti\""),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("file=\"../elsewhere/b.vti\""), std::string::npos) << text;
}

TEST(Collection, TakesPathsRelativeToTheWorkingFolder) {
  const ScratchFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  Collection("density.pvd").add(0, "density/density_0000.vti");
  Collection("out/density.pvd").add(0, "out/density/density_0000.vti");
  std::filesystem::current_path(before);
  for (const char* name : {"density.pvd", "out/density.pvd"})
    EXPECT_NE(read_file(folder / name).find("file=\"density/density_0000.vti\""), std::string::npos)
        << read_file(folder / name);
}

TEST(Collection, IsWholeAfterAFailedAdd) {
  const ScratchFolder folder;
  Collection series(folder / "density.pvd");
  series.add(0, folder / "a.vti");
  const std::string old = read_file(folder / "density.pvd");
  {
    const FileSizeLimit limit(50);
    EXPECT_THROW(series.add(1, folder / "b.vti"), FileError);
  }
  EXPECT_EQ(read_file(folder / "density.pvd"), old);
  series.add(2, folder / "c.vti");
  const std::string text = read_file(folder / "density.pvd");
  EXPECT_EQ(text.find("b.vti"), std::string::npos) << "the frame that failed is listed";
  EXPECT_NE(text.find("c.vti"), std::string::npos);
}

}  // namespace
}  // namespace gaussdrift::write
