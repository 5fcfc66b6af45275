// Velocities from tables of scattered points: what is read, and the promised message for everything wrong with a table.
#include "field/gaussians/gaussian_velocity.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <variant>

#include "cases.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::input {
namespace {

namespace fs = std::filesystem;

class GaussianTables : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) { std::ofstream(folder_ / name) << text; }
  /// A rotation at the points of a 5 x 5 lattice on [-1, 1]^2, in a table of these columns.
  void write_rotation(const std::string& name, const std::string& header = "x,y,u,v") {
    std::ofstream out(folder_ / name);
    out << header << "\n";
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 5; ++i) {
        const double x = i / 2.0 - 1, y = j / 2.0 - 1;
        if (header == "x,y,u,v") out << x << "," << y << "," << -y << "," << x << "\n";
        if (header == "v,x,u,y") out << x << "," << x << "," << -y << "," << y << "\n";
        if (header == "x,y,omega") out << x << "," << y << ",2\n";
      }
  }
  Case read(const std::string& velocity, const std::string& scene = cone) const {
    return parse_case(with(scene, scene == cone ? "u = [\"-y\", \"x\"]" : "u = [\"y\", \"z*t\", \"x\"]", velocity),
                      folder_ / "cone.toml")
        .spec;
  }
  std::string message(const std::string& velocity, const std::string& scene = cone) const {
    try {
      read(velocity, scene);
    } catch (const CaseError& error) {
      return error.what();
    }
    return "";
  }

  ScratchFolder folder_;
};

const GaussianVelocitySpec& spec_of(const Case& scene) { return std::get<GaussianVelocitySpec>(scene.velocity.at(0)); }

TEST_F(GaussianTables, AreReadAndFitted) {
  write_rotation("samples.csv");
  write_rotation("shuffled.csv", "v,x,u,y");
  const Case scene = read("gaussians = \"samples.csv\"");
  const GaussianModel& model = *spec_of(scene).model;
  EXPECT_EQ(spec_of(scene).kind, "velocity");
  EXPECT_EQ(model.matrix, GaussianMatrix::field);
  EXPECT_EQ(model.positions.size(), 50u);
  EXPECT_NEAR(model.width, 2 * std::sqrt(4.0 / 25), 2.3e-16);  // twice (V/N)^(1/2); rounding
  const auto field = make_gaussian_velocity(model, 1, 1);
  const double x = 0.5, y = -1;  // a sample
  double u = 0, v = 0;
  field->add(0, {2, 1, {&x, &y, nullptr}}, {2, 1, {&u, &v, nullptr}});
  EXPECT_NEAR(u, 1, 1e-6);  // the residual
  EXPECT_NEAR(v, 0.5, 1e-6);
  EXPECT_TRUE(field->is_solenoidal() && field->is_steady());
  EXPECT_EQ(model.coefficients, spec_of(read("gaussians = \"shuffled.csv\"")).model->coefficients);
}

TEST_F(GaussianTables, MayHoldVorticityOrCoefficients) {
  write_rotation("spin.csv", "x,y,omega");
  EXPECT_EQ(spec_of(read("gaussians = \"spin.csv\"\nkind = \"vorticity\"")).model->matrix, GaussianMatrix::curl);

  write("one.csv", "x,y,gamma\n0.25,0,3\n");
  const Case scene = read("gaussians = \"one.csv\"\nkind = \"curl-coefficients\"\nwidth = 0.5");
  const auto field = make_gaussian_velocity(*spec_of(scene).model, 1, 1);
  const double x = 0.5, y = 0.1;
  double u = 0, v = 0;
  field->add(0, {2, 1, {&x, &y, nullptr}}, {2, 1, {&u, &v, nullptr}});
  const double phi = std::exp(-(0.25 * 0.25 + 0.1 * 0.1) / 0.25);  // u = 3 (d phi/dy, -d phi/dx)
  EXPECT_NEAR(u, 3 * (-2 * 0.1 / 0.25) * phi, 7e-16);              // rounding
  EXPECT_NEAR(v, 3 * (2 * 0.25 / 0.25) * phi, 7e-16);

  write("space.csv", "x,y,z,gamma_x,gamma_y,gamma_z\n0.5,0.5,0.5,1,0,0\n");
  EXPECT_EQ(spec_of(read("gaussians = \"space.csv\"\nkind = \"coefficients\"\nwidth = 0.1", least)).model->dimension,
            3);
}

TEST_F(GaussianTables, HaveTheGradientOfTheirVelocity) {
  write("one.csv", "x,y,gamma\n0.25,0,3\n0.4,0.3,-2\n");
  write("space.csv", "x,y,z,gamma_x,gamma_y,gamma_z\n0.5,0.5,0.5,1,0,0.5\n");
  for (const int d : {2, 3}) {
    const Case scene = d == 2 ? read("gaussians = \"one.csv\"\nkind = \"curl-coefficients\"\nwidth = 0.5")
                              : read("gaussians = \"space.csv\"\nkind = \"coefficients\"\nwidth = 0.4", least);
    const auto field = make_gaussian_velocity(*spec_of(scene).model, 1, 1);
    const Vector x{0.45, 0.35, 0.6};
    const auto velocity = [&](Vector at) {
      Vector u{};
      PointsView points{d, 1, {}};
      VectorsView values{d, 1, {}};
      for (int k = 0; k < d; ++k) points.axis[k] = &at[k], values.axis[k] = &u[k];
      field->add(0, points, values);
      return u;
    };
    std::array<std::array<double, 3>, 3> slopes{};
    GradientsView view{d, 1, {}};
    PointsView point{d, 1, {}};
    for (int k = 0; k < d; ++k) {
      point.axis[k] = &x[k];
      for (int i = 0; i < d; ++i) view.slope[k][i] = &slopes[k][i];
    }
    field->add_gradient(0, point, view);
    for (int i = 0; i < d; ++i) {
      constexpr double h = 1e-3;
      const auto at = [&](double shift) {
        Vector y = x;
        y[i] += shift;
        return velocity(y);
      };
      const Vector near = at(h), back = at(-h), far = at(2 * h), far_back = at(-2 * h);
      for (int k = 0; k < d; ++k)
        EXPECT_NEAR(slopes[k][i], (8 * (near[k] - back[k]) - (far[k] - far_back[k])) / (12 * h), 1e-8 * 50) << k << i;
    }
  }
}

TEST_F(GaussianTables, AreWrittenIntoTheResolvedCase) {
  write_rotation("samples.csv");
  const Case scene = read("gaussians = \"samples.csv\"\nresidual = 1e-4\nregularisation = 1e-9");
  const Case again = parse_case(case_text(scene), "elsewhere/run.toml").spec;
  EXPECT_EQ(spec_of(again).model->coefficients, spec_of(scene).model->coefficients);
  EXPECT_EQ(spec_of(again).residual, 1e-4);
  EXPECT_EQ(spec_of(again).regularisation, 1e-9);
}

// Points at random have some that nearly coincide, and Gaussians of the default width can hardly be told apart there.
TEST_F(GaussianTables, OfRandomPointsAreFittedWithTheLeastRegularisationThatWillDo) {
  int refused = 0;
  for (const int seed : {1, 2, 3}) {
    std::mt19937 random(static_cast<unsigned>(seed));
    std::uniform_real_distribution<double> coordinate(-1.2, 1.2);
    {
      std::ofstream out(folder_ / "random.csv");
      out.precision(17);
      out << "x,y,u,v\n";
      for (int i = 0; i < 480; ++i) {
        const double x = coordinate(random), y = coordinate(random);
        out << x << "," << y << "," << std::sin(2 * x) * std::cos(2 * y) << "," << -std::cos(2 * x) * std::sin(2 * y)
            << "\n";
      }
    }
    const Case scene = read("gaussians = \"random.csv\"");
    const GaussianModel& model = *spec_of(scene).model;
    EXPECT_NE(model.about.find("residual "), std::string::npos) << model.about;
    const bool needed = !message("gaussians = \"random.csv\"\nregularisation = 0").empty();
    refused += needed;
    EXPECT_EQ(spec_of(scene).regularisation > 0, needed) << seed;
    EXPECT_LE(spec_of(scene).regularisation, 1e-6) << seed;
    EXPECT_EQ(model.about.find("(chosen: without it") != std::string::npos, needed) << model.about;
    const auto field = make_gaussian_velocity(model, 1, 1);
    for (const double x : {-0.6, 0.1, 0.5})
      for (const double y : {-0.4, 0.3}) {
        double u = 0, v = 0;
        field->add(0, {2, 1, {&x, &y, nullptr}}, {2, 1, {&u, &v, nullptr}});
        EXPECT_NEAR(u, std::sin(2 * x) * std::cos(2 * y), 2e-3) << seed;  // samples lie 0.1 apart
        EXPECT_NEAR(v, -std::cos(2 * x) * std::sin(2 * y), 2e-3) << seed;
      }
    // The run's own case file names what was chosen, and gives the same field.
    const Case again = parse_case(case_text(scene), "elsewhere/run.toml").spec;
    EXPECT_EQ(spec_of(again).regularisation, spec_of(scene).regularisation);
    EXPECT_EQ(spec_of(again).model->coefficients, model.coefficients);
  }
  EXPECT_GE(refused, 2) << "such points need it";
  // So do vorticities under wide Gaussians, and points in space.
  write("wave.csv", "x,y,u,v\n0,0,1,0\n0.1,0,-1,0\n0.2,0,1,0\n0,0.1,-1,0\n0.1,0.1,1,0\n0.2,0.1,-1,0\n0,0.2,1,0\n");
  const std::string hopeless = message("gaussians = \"wave.csv\"\nwidth = 30");
  EXPECT_NE(hopeless.find("regularisation up to 1e-6 does not help. Lower width"), std::string::npos) << hopeless;
  EXPECT_EQ(hopeless.find("1e-8 is a beginning"), std::string::npos) << "it was tried";
  write_rotation("spin.csv", "x,y,omega");
  EXPECT_GT(spec_of(read("gaussians = \"spin.csv\"\nkind = \"vorticity\"\nwidth = 30")).regularisation, 0);
  std::ofstream space(folder_ / "space.csv");
  space << "x,y,z,u,v,w\n";
  for (int i = 0; i < 64; ++i)
    space << i % 4 / 3. << "," << i / 4 % 4 / 3. << "," << i / 16 / 3. << "," << -(i / 4 % 4) / 3. << "," << i % 4 / 3.
          << ",0\n";
  space.close();
  EXPECT_GT(spec_of(read("gaussians = \"space.csv\"\nwidth = 20", least)).regularisation, 0);
}

TEST_F(GaussianTables, GetThePromisedMessages) {
  write_rotation("samples.csv");
  write("header.csv", "x,y,u\n0,0,1\n");
  write("odd.csv", "x,y,u,v,temperature\n0,0,1,0,3\n");
  write("nan.csv", "x,y,u,v\n0,0,1,0\n0.5,0,nan,0\n");
  write("word.csv", "x,y,u,v\n0,0,1,fast\n");
  write("short.csv", "x,y,u,v\n0,0,1\n");
  write("twice.csv", "x,y,u,v\n0,0,1,0\n0.5,0,1,0\n0,0,1,1\n");
  write("same.csv", "x,y,u,v\n0,0,1,0\n0.5,0,1,0\n0,0,1,0\n");
  write("empty.csv", "");
  write("commented.csv", "# made by a tool\n\nx,y,u,v\n0,0,1,0\n# between\n0.5,0,1,0\n0,0,1,1\n");
  write("id.csv", "id,x,y,u,v\n1,0,0,1,0\n");
  write("blanks.csv", "x y u v\n0 0 1\n");
  write("wind.nc", "CDF\001 and what follows");
  write("passwd", "root:x:0:0:root:/root:/bin/bash\n");
  struct Wrong {
    std::string velocity, message;
  };
  const std::string place = folder_.path().string() + "/";
  for (const auto& [velocity, expected] : std::vector<Wrong>{
           {"gaussians = \"none.csv\"", "cannot read " + place + "none.csv: No such file or directory"},
           {"gaussians = 3", "velocity.gaussians must be the name of a file in a string"},
           {"gaussians = \"header.csv\"",
            "header.csv:1:1: there is no column \"v\" among x, y, u; the columns must be x,y,u,v"},
           {"gaussians = \"odd.csv\"", "odd.csv:1:9: column \"temperature\" is not one of those that are wanted"},
           {"gaussians = \"nan.csv\"", "nan.csv:3:7: nan is not finite in column \"u\""},
           {"gaussians = \"word.csv\"", "word.csv:2:7: \"fast\" is not a number in column \"v\""},
           {"gaussians = \"short.csv\"", "short.csv:2:6: 3 values where 4 columns are named"},
           {"gaussians = \"twice.csv\"",
            "twice.csv:4:1: the sample at (0, 0) stands in line 2 already, with different values"},
           {"gaussians = \"same.csv\"", "same.csv:4:1: the sample at (0, 0) stands in line 2 already; no field"},
           {"gaussians = \"empty.csv\"", "empty.csv is empty"},
           {"gaussians = \"commented.csv\"",
            "commented.csv:7:1: the sample at (0, 0) stands in line 4 already, with different values"},
           {"gaussians = \"id.csv\"",
            "id.csv:1:1: column \"id\" is not one of those that are wanted; the columns must be x,y,u,v: remove it"},
           {"gaussians = \"blanks.csv\"", "blanks.csv:2:6: 3 values where 4 columns are named (x, y, u, v)"},
           {"gaussians = \"wind.nc\"", "wind.nc is a NetCDF file; with Python"},
           {"gaussians = \"passwd\"",
            "passwd:1:1: there is no column \"x\" among root:x:0:0:root:/root:/b...; the columns must be x,y,u,v"},
           {"gaussians = \"samples.csv\"\nkind = \"vorticty\"", "did you mean \"vorticity\"?"},
           {"gaussians = \"samples.csv\"\nkind = \"vorticity\"", "the columns must be x,y,omega"},
           {"gaussians = \"samples.csv\"\nwidth = 0", "velocity.width must be greater than 0"},
           {"gaussians = \"samples.csv\"\nwidth = 30\nregularisation = 0",
            "Gaussians of width 30 can hardly be told apart"},
           {"gaussians = \"samples.csv\"\nwidth = 0.05", "do not follow from each other"},
           {"gaussians = \"samples.csv\"\nresidual = 2", "velocity.residual must be"},
           {"gaussians = \"samples.csv\"\ntolerance = 1e-13", "the Gaussians cancel"},
           {"gaussians = \"samples.csv\"\nkind = \"coefficients\"\nresidual = 1e-3",
            "\"residual\" is for fits to samples"},
           {"u = [\"-y\", \"x\"]\nwidth = 1", "\"width\" goes with \"gaussians\""},
       }) {
    const std::string text = message(velocity);
    EXPECT_NE(text.find(expected), std::string::npos) << velocity << "\n" << text;
    EXPECT_NE(text.find("--> "), std::string::npos) << "no place in the case file\n" << text;
  }
  // A table of the plane in a domain of space.
  EXPECT_NE(message("gaussians = \"samples.csv\"", least).find("there is no column \"z\" among x, y, u, v"),
            std::string::npos)
      << message("gaussians = \"samples.csv\"", least);
}

}  // namespace
}  // namespace gaussdrift::input
