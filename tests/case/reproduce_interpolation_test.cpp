// The study of interpolation, for few points.
#include "reproduce/interpolation.hpp"

#include <gtest/gtest.h>

#include "parsed_json.hpp"

namespace gaussdrift::reproduce {
namespace {

TEST(ReproduceInterpolation, FindsTheRatesAndIntegrals) {
  const InterpolationReproduction result =
      reproduce_interpolation({.fewest_points = 100, .most_points = 400, .targets = 500});
  ASSERT_EQ(result.fits.size(), 8u);
  for (const InterpolationFit& fit : result.fits) {
    EXPECT_FALSE(fit.refused) << fit.kernel << fit.points;
    EXPECT_LT(fit.error, fit.points == 100 ? 5e-2 : 5e-3) << fit.kernel;  // the function is 0.5
    EXPECT_GT(fit.left_out, fit.error / 10) << fit.kernel << fit.points;
    EXPECT_LT(fit.left_out, fit.error * 10) << fit.kernel << fit.points;
    EXPECT_LT(fit.integral_error, fit.error) << fit.kernel << fit.points;  // by the inequality of Cauchy and Schwarz
    EXPECT_EQ(fit.shape == 0, fit.kernel == "thin-plate");
    EXPECT_EQ(fit.rate != 0, fit.points > 100);
  }
  ASSERT_EQ(result.rates.size(), 4u);
  for (const InterpolationRate& rate : result.rates)  // few points: not all of the rate is there
    EXPECT_GT(rate.measured, rate.stated - 1) << rate.kernel;
  ASSERT_EQ(result.solvers.size(), 4u);
  for (const InterpolationSolvers& both : result.solvers) {
    EXPECT_LE(both.krylov_error, 1.01 * both.dense_error) << both.kernel;
    EXPECT_LT(both.apart, 1e-5) << both.kernel;
  }
  const auto json = parsed_json(to_json(result));
  EXPECT_EQ(json["fits"].size(), 8u);
  EXPECT_TRUE(json["fits"][0]["rate"].is_null());
  EXPECT_EQ(json["agrees"], result.agrees());
  EXPECT_NE(to_text(result).find("multiquadric      400"), std::string::npos) << to_text(result);
}

TEST(ReproduceInterpolation, SaysWhereARateIsNotReached) {
  InterpolationReproduction result;
  result.rates = {{.kernel = "thin-plate", .measured = 2.1, .stated = 2}};
  EXPECT_TRUE(result.agrees());
  EXPECT_NE(to_text(result).find("Errors fall as stated, and both solvers agree"), std::string::npos);
  result.rates[0].measured = 1.9;
  EXPECT_FALSE(result.agrees());
  EXPECT_NE(to_text(result).find("NOT REACHED"), std::string::npos);
  result.rates.clear();
  result.solvers = {{.kernel = "thin-plate", .dense_error = 1e-3, .krylov_error = 1.6e-3}};
  EXPECT_FALSE(result.agrees());
}

}  // namespace
}  // namespace gaussdrift::reproduce
