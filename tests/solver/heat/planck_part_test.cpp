#include "solver/heat/planck_part.h"

#include <gtest/gtest.h>

#include <cmath>

namespace halfshade {
namespace {

struct Known {
  double shortest, longest, temperature, share, slope;
};

// Computed apart, in numbers of 80 bits, by Gauss's rule of 30 places on parts of length 1; slopes
// by differences, to four digits at least.
constexpr Known known[] = {{3, 3.0001, 900, 2.0171276042321668e-05, 0.0001080108551},
                           {3, 3.0000001, 900, 2.017115687910798e-08, 1.080119687e-07},
                           {10, 10.001, 300, 6.7879363980138488e-05, 0.0003282409483},
                           {.4, .5, 900, 7.1991415608947061e-11, 2.380334191e-09},
                           {.4, .5, 100, 3.9675823127980492e-119, 1.145703786e-116},
                           {8, 12, 300, 0.26334108997463662, 1.29214444},
                           {1e4, 1e4 + 1, 1e6, 4.5854815651744894e-23, 4.585484864e-23},
                           {0, 3, 5800, 0.97899415468910156, 3.971948008},
                           {100, HUGE_VAL, .002, 1, 4},
                           {3, 5, 1e6, 4.4303265694406805e-09, 4.439178144e-09},
                           {1, 1e9, 5000, 0.36627412808408971, 0.8355423392}};

TEST(PlanckPart, IsRightToRoundingOfItselfHoweverNarrowOrFarOut) {
  for (const Known& one : known) {
    SCOPED_TRACE(testing::Message()
                 << one.shortest << " to " << one.longest << " µm, " << one.temperature << " K");
    const PlanckPart part = planck_part(one.shortest, one.longest, one.temperature);
    // Far out the wavelengths' own rounding counts.
    EXPECT_NEAR(part.share, one.share, 1e-13 * one.share);
    EXPECT_NEAR(part.slope, one.slope, 1e-5 * one.slope);
  }
}

TEST(PlanckPart, OfPartsAddsUp) {
  for (const double kelvin : {1e-3, 3., 300., 6000., 1e6}) {
    const double middle = 3000 / kelvin;
    double share = 0, slope = 0, last = 0;
    for (int k = -60; k <= 60; ++k) {
      const double next = k == 60 ? HUGE_VAL : middle * std::pow(1.3, k);
      const PlanckPart part = planck_part(last, next, kelvin);
      share += part.share;
      slope += part.slope;
      last = next;
    }
    EXPECT_NEAR(share, 1, 1e-14);
    EXPECT_NEAR(slope, 4, 1e-13);
  }
}

TEST(PlanckPart, OfNothingIsNothing) {
  EXPECT_EQ(planck_part(3, 3, 300).share, 0);
  EXPECT_EQ(planck_part(0, HUGE_VAL, 0).share, 0);
  EXPECT_EQ(planck_part(.4, .5, 1e-3).share, 0);
  EXPECT_EQ(planck_part(.4, .5, 1e-3).slope, 0);
  EXPECT_EQ(planck_part(0, HUGE_VAL, 300).share, 1);
  EXPECT_EQ(planck_part(0, HUGE_VAL, 300).slope, 4);
}

}  // namespace
}  // namespace halfshade
