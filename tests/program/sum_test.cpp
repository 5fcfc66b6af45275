// gaussdrift sum: right values in the promised layout.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "parsed_json.hpp"
#include "program/program.hpp"
#include "program/sum_tables.hpp"

namespace gaussdrift {
namespace {

/// d^n/dx^n exp(-sigma x^2) = (-1)^n sigma^(n/2) H_n(sqrt(sigma) x) exp(-sigma x^2),  H_{n+1}(t) = 2 t H_n - 2 n
/// H_{n-1}
double gaussian(double x, double sigma, int n) {
  const double t = std::sqrt(sigma) * x;
  double before = 0, now = 1;
  for (int k = 0; k < n; ++k) before = std::exchange(now, 2 * t * now - 2 * k * before);
  return (n % 2 ? -1 : 1) * std::pow(sigma, 0.5 * n) * now * std::exp(-sigma * x * x);
}

double exact(const Rows& sources, const std::vector<double>& target, double sigma, const std::vector<int>& alpha) {
  double sum = 0;
  for (const auto& source : sources) {
    double term = source.back();
    for (std::size_t k = 0; k < alpha.size(); ++k) term *= gaussian(target[k] - source[k], sigma, alpha[k]);
    sum += term;
  }
  return sum;
}

/// N_alpha = sigma^(|alpha|/2) sqrt(2^|alpha| alpha!), the scale that a tolerance is relative to.
double scale(double sigma, const std::vector<int>& alpha) {
  double square = 1;
  for (const int n : alpha)
    for (int k = 1; k <= n; ++k) square *= 2 * sigma * k;
  return std::sqrt(square);
}

double weight_total(const Rows& sources) {
  double total = 0;
  for (const auto& source : sources) total += std::abs(source.back());
  return total;
}

TEST(Sum, MatchesTheFormulaInOneToFourDimensions) {
  const ScratchFolder folder;
  for (int d = 1; d <= 4; ++d) {
    const Rows sources = points(60, d + 1), targets = points(25, d);
    write_file(folder / "S.csv", csv(headers[d], sources));
    write_file(folder / "T.csv", csv(target_headers[d], targets));
    std::vector<int> mixed(d, 0);
    mixed.front() = 2, mixed.back() += 1;
    std::string list = std::to_string(mixed[0]), plain = "0";
    for (int k = 1; k < d; ++k) list.append(",").append(std::to_string(mixed[k])), plain.append(",0");
    const double sigma = 3;
    const Outcome sum =
        gaussdrift_in(folder, "sum --sources S.csv --targets T.csv --sigma 3 --tolerance 1e-9 --derivative " + list +
                                  " --derivative " + plain);
    ASSERT_EQ(sum.exit_code, 0) << sum.err;
    const Table table = table_of(sum.out);
    ASSERT_EQ(table.rows.size(), targets.size());
    for (std::size_t i = 0; i < targets.size(); ++i) {
      ASSERT_EQ(table.rows[i].size(), 2u);
      const double allowed = 1e-9 * weight_total(sources);  // the promise summed over all terms
      EXPECT_NEAR(table.rows[i][0], exact(sources, targets[i], sigma, mixed), allowed * scale(sigma, mixed)) << d;
      EXPECT_NEAR(table.rows[i][1], exact(sources, targets[i], sigma, std::vector<int>(d, 0)), allowed) << d;
    }
  }
}

TEST(Sum, NamesColumnsByDerivativeAndKeepsTheirOrder) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", csv(headers[3], points(5, 4)));
  EXPECT_EQ(table_of(gaussdrift_in(folder, "sum --sources S.csv --sigma 2").out).header, "d_0_0_0");
  EXPECT_EQ(
      table_of(gaussdrift_in(folder,
                             "sum --sources S.csv --sigma 2 --derivative 0,1,2 --derivative=10,0,0 --derivative 0,0,0")
                   .out)
          .header,
      "d_0_1_2,d_10_0_0,d_0_0_0");
}

TEST(Sum, TakesTheSourcesAsTargets) {
  const ScratchFolder folder;
  const Rows sources = points(40, 3);
  write_file(folder / "S.csv", csv("weight,x,y", {{2, 0.25, 0.5}, {-1, 0.75, 0.5}}));
  const Outcome two = gaussdrift_in(folder, "sum --sources S.csv --sigma 4 --method direct");
  ASSERT_EQ(two.exit_code, 0) << two.err;
  const Table table = table_of(two.out);
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_NEAR(table.rows[0][0], 2 - std::exp(-1), 1e-15);  // distance 1/2, each source counts for itself: rounding
  EXPECT_NEAR(table.rows[1][0], -1 + 2 * std::exp(-1), 1e-15);
}

TEST(Sum, TakesTheColumnsThatAreNamedAndAsksWhereItWouldGuess) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", "# exported\nid,x,y,weight\n1,0,0,1\n2,1,0,1\n");
  const Outcome named =
      gaussdrift_in(folder, "sum --sources S.csv --targets S.csv --columns x,y --sigma 1 --method direct");
  ASSERT_EQ(named.exit_code, 0) << named.err;
  EXPECT_EQ(named.err, "");
  EXPECT_NEAR(table_of(named.out).rows.at(0).at(0), 1 + std::exp(-1), 1e-15);  // and not with id as an axis: 1 + e^-2
  write_file(folder / "odd.csv", "x,y,speed,weight\n0,0,3,1\n");
  const Outcome doubted = gaussdrift_in(folder, "sum --sources odd.csv --sigma 1");
  EXPECT_EQ(doubted.exit_code, 0);
  EXPECT_EQ(doubted.err.rfind("warning: odd.csv: the column \"speed\" is read as a coordinate; --columns x,y", 0), 0u)
      << doubted.err;
}

TEST(Sum, RunsAlongTheFirstAxisOfAGridFastest) {
  const ScratchFolder folder;
  const Rows sources = points(30, 3);
  write_file(folder / "S.csv", csv(headers[2], sources));
  const Outcome sum =
      gaussdrift_in(folder, "sum --sources S.csv --grid=-1:1:5,0:3:4 --sigma 2 --derivative 1,0 --tolerance 1e-11");
  ASSERT_EQ(sum.exit_code, 0) << sum.err;
  const Table table = table_of(sum.out);
  ASSERT_EQ(table.rows.size(), 20u);
  for (int j = 0, row = 0; j < 4; ++j)
    for (int i = 0; i < 5; ++i, ++row)
      EXPECT_NEAR(table.rows[row][0], exact(sources, {-1 + 0.5 * i, 1.0 * j}, 2, {1, 0}),
                  1e-11 * weight_total(sources) * scale(2, {1, 0}));  // the promise
  const Outcome single = gaussdrift_in(folder, "sum --sources S.csv --grid=1:1:1,0:3:4 --sigma 2");
  ASSERT_EQ(single.exit_code, 0) << single.err;
  EXPECT_EQ(table_of(single.out).rows.size(), 4u);
}

TEST(Sum, KeepsThePromiseWithEveryMethod) {
  const ScratchFolder folder;
  const Rows sources = points(300, 3);
  write_file(folder / "S.csv", csv(headers[2], sources));
  const Outcome unknown = gaussdrift_in(folder, "sum --sources S.csv --sigma 30 --method none");
  ASSERT_EQ(unknown.exit_code, 2);
  std::istringstream names(unknown.err.substr(unknown.err.find("there are ") + 10));  // the list of all methods
  int methods = 0;
  for (std::string name; names >> name; ++methods) {
    if (name.back() == ',') name.pop_back();
    const Outcome sum = gaussdrift_in(
        folder, "sum --sources S.csv --sigma 30 --tolerance 1e-8 --derivative 1,1 --out V.csv --json --method " + name);
    ASSERT_EQ(sum.exit_code, 0) << name << sum.err;
    EXPECT_EQ(parsed_json(sum.out)["method_asked"], name);
    const Table table = table_of(read_file(folder / "V.csv"));
    ASSERT_EQ(table.rows.size(), sources.size());
    for (std::size_t i = 0; i < sources.size(); ++i)
      EXPECT_NEAR(table.rows[i][0], exact(sources, sources[i], 30, {1, 1}),
                  1e-8 * weight_total(sources) * scale(30, {1, 1}))
          << name;  // the promise
  }
  EXPECT_GE(methods, 3);  // auto, direct, hermite
}

TEST(Sum, WritesTheSameBytesOnAnyNumberOfThreads) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", csv(headers[3], points(2000, 4)));
  const std::string call = "sum --sources S.csv --sigma 20 --derivative 0,1,0 --threads ";
  const Outcome one = gaussdrift_in(folder, call + "1"), three = gaussdrift_in(folder, call + "3");
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(one.out, three.out);
  EXPECT_EQ(one.err, "");
}

TEST(Sum, WritesNumbersThatReadBackAsTheSameDouble) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", "x,weight\n0,0.1\n");
  const Outcome sum = gaussdrift_in(folder, "sum --sources S.csv --sigma 1 --method direct");
  EXPECT_EQ(sum.out, "d_0\n0.10000000000000001\n");
}

TEST(Sum, TellsWhatWasChosenAsJson) {
  const ScratchFolder folder;
  const Rows sources = points(500, 3);
  write_file(folder / "S.csv", csv(headers[2], sources));
  const Outcome sum = gaussdrift_in(folder,
                                    "sum --sources S.csv --grid=0:1:40,0:1:30 --sigma 100 --derivative 2,0 --method "
                                    "hermite --tolerance 1e-7 --threads 1 --out V.csv --json");
  ASSERT_EQ(sum.exit_code, 0) << sum.err;
  EXPECT_EQ(sum.err, "");
  const auto json = parsed_json(sum.out);
  EXPECT_EQ(json["kernel"], "gauss");
  EXPECT_EQ(json["dimension"], 2);
  EXPECT_EQ(json["sources"], 500);
  EXPECT_EQ(json["targets"], 1200);
  EXPECT_EQ(json["columns"], nlohmann::json::array({"d_2_0"}));
  EXPECT_EQ(json["method"], "hermite");
  EXPECT_EQ(json["tolerance"], 1e-7);
  EXPECT_EQ(json["threads"], 1);
  EXPECT_GE(json["parameters"]["expansion_order"].get<int>(), 1);
  EXPECT_LE(json["bound"].get<double>(), 1e-7 * (1 + 1e-9));  // rounding of the bound itself
  const double total = weight_total(sources);
  EXPECT_NEAR(json["Q"].get<double>(), total, 2.5e-15 * total);  // rounding of 500 terms, sqrt(500) 1.1e-16
  EXPECT_LE(json["error_bounds"]["d_2_0"].get<double>(), (1e-7 + 3e-14) * total * scale(100, {2, 0}) * (1 + 1e-9));
  EXPECT_EQ(json["measured"]["kept"], true);
  EXPECT_LE(json["measured"]["errors"]["d_2_0"].get<double>(), 1e-7);
  for (const char* stage : {"read", "prepare", "evaluate", "compare", "write"})
    EXPECT_GE(json["seconds"][stage].get<double>(), 0) << stage;
  EXPECT_EQ(table_of(read_file(folder / "V.csv")).rows.size(), 1200u);
}

// The thesis's parameters: their bound is told in place of a tolerance, and holds.
TEST(Sum, TakesRAndPAndNByHand) {
  const ScratchFolder folder;
  std::string table = "x,y,weight\n";
  for (int j = 0; j < 400; ++j)
    table += std::to_string(std::fmod(0.381966 * j, 1.0)) + "," + std::to_string(std::fmod(0.754878 * j, 1.0)) + "," +
             std::to_string(j % 3 - 1) + "\n";
  write_file(folder / "S.csv", table);
  const auto by_hand = [&](const std::string& options) {
    const Outcome sum = gaussdrift_in(folder, "sum --sources S.csv --sigma 40 --out V.csv --json " + options);
    EXPECT_EQ(sum.exit_code, 0) << sum.err;
    return parsed_json(sum.out);
  };
  double before = 1e300;
  for (const int p : {3, 6, 9, 14}) {
    const auto told = by_hand("--r 0.5 --p " + std::to_string(p));
    EXPECT_EQ(told["method"], "hermite");
    EXPECT_EQ(told["parameters"]["box_scale"], 0.5);
    EXPECT_EQ(told["parameters"]["expansion_order"], p);
    EXPECT_EQ(told["parameters"]["neighbours"], "all");
    EXPECT_EQ(told["parameters"]["cost"], 400.0 * p * p + told["parameters"]["boxes"].get<double>() * p * p * 400);
    const double bound = told["bound"];
    EXPECT_LT(bound, before);
    EXPECT_LE(told["measured"]["errors"]["d_0_0"].get<double>(), bound);
    before = bound;
  }
  const auto near = by_hand("--p 9 --n 2 --method hermite");
  EXPECT_EQ(near["parameters"]["neighbours"], 2);
  EXPECT_GT(near["bound"].get<double>(), 1e-3) << "boxes further away are left out";
  EXPECT_TRUE(by_hand("--r 1.2 --p 25")["bound"].is_null()) << "(3.5) needs r < 1";
}

TEST(Sum, ReplacesAnEarlierResultAndLeavesNothingBeside) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", "x,weight\n0,1\n");
  write_file(folder / "V.csv", "an earlier result\n");
  const Outcome sum = gaussdrift_in(folder, "sum --sources S.csv --sigma 1 --out V.csv");
  ASSERT_EQ(sum.exit_code, 0) << sum.err;
  EXPECT_EQ(table_of(read_file(folder / "V.csv")).header, "d_0");
  EXPECT_FALSE(fs::exists(folder / "V.csv.part"));
  EXPECT_NE(sum.out.find("V.csv"), std::string::npos) << sum.out;
}

TEST(Sum, WritesIntoPipesAndDevicesWithoutReplacingThem) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", "x,weight\n0,1\n");
  const Outcome sum =
      gaussdrift_in(folder, "sum --sources S.csv --sigma 1 --out pipe >said & cat pipe; wait", "mkfifo pipe;");
  ASSERT_EQ(sum.exit_code, 0) << sum.err;
  EXPECT_EQ(sum.out, "d_0\n1\n");
  EXPECT_TRUE(fs::is_fifo(folder / "pipe"));
}

TEST(Sum, OfChargesIsPotentialAndField) {
  const ScratchFolder folder;
  write_file(folder / "S3.csv", "x,y,z,weight\n0,0,0,2\n0,3,4,-1\n");
  const Table space = table_of(gaussdrift_in(folder, "sum --kernel coulomb --sources S3.csv").out);
  EXPECT_EQ(space.header, "potential,fx,fy,fz");
  EXPECT_NEAR(space.rows[0][0], -1.0 / 5, 1e-15);
  EXPECT_NEAR(space.rows[0][2], -1.0 * -3 / 125, 1e-15);
  EXPECT_NEAR(space.rows[1][3], 2.0 * 4 / 125, 1e-15);
  write_file(folder / "S2.csv", "x,y,weight\n0,0,2\n3,4,-1\n");
  const Table plane = table_of(gaussdrift_in(folder, "sum --kernel coulomb --sources S2.csv --grid=3:3:1,4:4:1").out);
  EXPECT_EQ(plane.header, "potential,fx,fy");
  EXPECT_NEAR(plane.rows[0][0], -2 * std::log(5.0), 1e-15);
  EXPECT_NEAR(plane.rows[0][1], 2.0 * 3 / 25, 1e-15);
  const Table log = table_of(gaussdrift_in(folder, "sum --kernel log --sources S2.csv").out);
  EXPECT_EQ(log.header, "potential,gx,gy");
  EXPECT_NEAR(log.rows[1][0], 2 * std::log(5.0), 1e-15);
  EXPECT_NEAR(log.rows[1][2], 2.0 * 4 / 25, 1e-15);
}

TEST(Sum, OfManyChargesByTreeAndSymmetricIsRightToTheTolerance) {
  const ScratchFolder folder;
  write_file(folder / "S.csv", csv("x,y,z,weight", points(1500, 4)));
  const Table exact = table_of(gaussdrift_in(folder, "sum --kernel coulomb --sources S.csv --method direct").out);
  for (const std::string method : {"tree", "symmetric"}) {
    const Outcome done = gaussdrift_in(
        folder, "sum --kernel coulomb --sources S.csv --tolerance 1e-4 --out V.csv --json --method " + method);
    ASSERT_EQ(done.exit_code, 0) << done.err;
    const auto json = parsed_json(done.out);
    EXPECT_EQ(json["method"], method);
    EXPECT_LE(json["bound"], 1e-4);
    const Table found = table_of(read_file(folder / "V.csv"));
    double error = 0, size = 0;
    for (std::size_t i = 0; i < exact.rows.size(); ++i)
      for (int k = 1; k < 4; ++k) {
        error += std::pow(found.rows[i][k] - exact.rows[i][k], 2);
        size += std::pow(exact.rows[i][k], 2);
      }
    EXPECT_LE(std::sqrt(error / size), 1e-4) << method;  // charges of one sign: the field is not far below sum |q|/r^2
    EXPECT_LE(json["measured"]["field_error"], 1e-4) << method;
  }
}

TEST(Sum, OfTooLittleMemorySaysWhatTheProgramTakesItself) {
  const ScratchFolder folder;
  write_file(folder / "p.csv", csv("x,y,weight", points(10, 3)));
  const Outcome out = gaussdrift_in(folder, "sum --sources p.csv --sigma 1 --memory '1 MB'");
  EXPECT_EQ(out.exit_code, 3);
  EXPECT_NE(out.err.find("--memory allows 1 MB, and the program itself takes "), std::string::npos) << out.err;
  EXPECT_EQ(out.err.find(" 0"), std::string::npos) << out.err;
}

/// Two processes that write one table: it is that of one of them, from its first line to its last.
TEST(Sum, OfTwoProcessesIntoOneFileIsThatOfOneOfThem) {
  const ScratchFolder folder;
  write_file(folder / "p.csv", csv("x,y,weight", points(3000, 3)));
  const std::string sum = "'" PROGRAM "' sum --sources p.csv --method direct --threads 1 --sigma ";
  for (const char* sigma : {"1", "2"})
    ASSERT_EQ(outcome_of(folder, sum + sigma + " --out alone" + sigma + ".csv").exit_code, 0);
  const std::string one = read_file(folder / "alone1.csv"), other = read_file(folder / "alone2.csv");
  ASSERT_NE(one, other);
  for (int time = 0; time < 5; ++time) {
    const Outcome both =
        outcome_of(folder, sum + "1 --out v.csv & " + sum + "2 --out v.csv; second=$?; wait $! && exit $second");
    EXPECT_EQ(both.exit_code, 0) << both.err;
    const std::string written = read_file(folder / "v.csv");
    EXPECT_TRUE(written == one || written == other) << written.substr(0, 200);
  }
  for (const auto& entry : fs::directory_iterator(folder.path()))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
}

}  // namespace
}  // namespace gaussdrift
