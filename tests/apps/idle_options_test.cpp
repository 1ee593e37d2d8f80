// Options that cannot have what they ask for, or would do nothing, say so.

#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace halfshade {
namespace {

using CommandWords = std::vector<std::string>;

class IdleOptions : public testing::Test {
 protected:
  test::Outcome run(const CommandWords& words) {
    return test::run_halfshade(words, folder_.path());
  }
  test::Outcome solve(const CommandWords& more) {
    CommandWords words = {"solve", s1_, "-o", "o.vtu", "--json", "r.json"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  nlohmann::json report() {
    return nlohmann::json::parse(test::contents(folder_.path() / "r.json"));
  }
  int elements() { return report().at("mesh").at("elements"); }
  std::string result() { return test::contents(folder_.path() / "o.vtu"); }
  struct Idle {
    CommandWords words;
    std::string option, why;
  };
  void expect_noted(const std::vector<Idle>& all) {
    for (const Idle& idle : all) {
      SCOPED_TRACE(testing::PrintToString(idle.words));
      const test::Outcome outcome = run(idle.words);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
      const std::string note = "note: " + idle.option + " changes nothing: it " + idle.why;
      EXPECT_NE(outcome.err.find(note), std::string::npos) << outcome.err;
    }
  }
  void expect_nothing_noted(CommandWords words) {
    const test::Outcome outcome = run(words);
    EXPECT_EQ(outcome.exit_code, 0) << testing::PrintToString(words) << outcome.err;
    EXPECT_EQ(outcome.err.find("changes nothing"), std::string::npos) << outcome.err;
  }

  test::TempDir folder_;
  const std::string s1_ = test::data_file("s1.obj").string();
};

TEST_F(IdleOptions, MoreElementsThanThereMayBeAreNotTheScenesFault) {
  for (const CommandWords& method : {CommandWords{"--refine", "uniform"}, {"--method", "matrix"}}) {
    const auto with = [&](CommandWords words) {
      words.insert(words.end(), method.begin(), method.end());
      return solve(words);
    };
    test::expect_sentence(with({"--elements", "1000", "--max-elements", "20"}), 2,
                          "--elements: 1000 are more than the 20 that --max-elements allows");
    test::expect_sentence(with({"--elements", "100000"}), 3,
                          "100000 elements are asked for with --elements, and there may be 40000; "
                          "--max-elements allows more");
    // Three squares take two triangles each.
    test::expect_sentence(with({"--max-elements", "5"}), 3,
                          "3 surfaces with 0 contact lines take more than 5 elements");
    test::expect_sentence(with({"--max-length", "0.001"}), 3, "elements of at most 0.001");
  }
}

TEST_F(IdleOptions, WhereNoNumberIsAskedForThereAreAsManyAsThereMayBe) {
  for (const char* most : {"6", "20", "300"})
    for (const CommandWords& method :
         {CommandWords{"--refine", "uniform"}, {"--method", "matrix"}}) {
      CommandWords words = {"-q", "--max-elements", most};
      words.insert(words.end(), method.begin(), method.end());
      const test::Outcome outcome = solve(words);
      ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
      EXPECT_LE(elements(), std::stoi(most));
      EXPECT_GE(elements(), std::max(6., 0.4 * std::stoi(most)));
    }
}

TEST_F(IdleOptions, UnknownsThatTheFewestElementsTakeAreTold) {
  const std::string says = "before any element is divided, more than the 10 that --max-unknowns";
  const test::Outcome outcome = solve({"--max-unknowns", "10"});
  EXPECT_EQ(outcome.exit_code, 4);
  EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
  EXPECT_EQ(report().at("warnings").at(0).at("kind"), "unknowns_exceeded");
  const test::Outcome reached = solve({"--max-unknowns", "10", "--order", "3"});
  EXPECT_EQ(reached.exit_code, 0) << "the tolerance is met all the same";
  EXPECT_NE(reached.err.find(says), std::string::npos) << reached.err;
  EXPECT_EQ(solve({"--max-unknowns", "10", "--order", "0"}).err.find("warning"), std::string::npos)
      << "one on each of six triangles";
}

TEST_F(IdleOptions, OrdersMayBeAutomatic) {
  ASSERT_EQ(solve({"-q"}).exit_code, 0);
  const std::string usual = result();
  ASSERT_EQ(solve({"-q", "--order", "auto"}).exit_code, 0);
  EXPECT_EQ(result(), usual);
  ASSERT_EQ(solve({"-q", "--order", "AUTO", "--method", "matrix", "--elements", "20"}).exit_code,
            0);
  EXPECT_NE(run({"solve", "--help"}).out.find("--order N|auto"), std::string::npos);
  for (const char* wrong : {"9", "-1", "automatic", "1.5", ""})
    test::expect_sentence(solve({"--order", wrong}), 2, "--order:");
}

TEST_F(IdleOptions, OfSolveAreTold) {
  const auto words = [&](CommandWords more) {
    more.insert(more.begin(), {"solve", s1_});
    return more;
  };
  const auto matrix = [&](CommandWords more) {
    more.insert(more.begin(), {"solve", s1_, "--method", "matrix", "--elements", "20"});
    return more;
  };
  const auto plain = [&](CommandWords more) {
    more.insert(more.begin(), {"solve", s1_, "--no-discontinuity"});
    return more;
  };
  const std::string needs = "is for constant elements; give --method matrix";
  const std::string of_matrix = "has no part in constant elements";
  expect_noted({
      {words({"--refine", "adaptive", "--elements", "50"}), "--elements", "has no part"},
      {words({"--refine", "adaptive", "--max-length", ".1"}), "--max-length", "has no part"},
      {words({"--elements", "50", "--max-length", ".1"}), "--elements", "has no part"},
      {words({"--rays", "3"}), "--rays", needs},
      {words({"--hemicube", "8"}), "--hemicube", needs},
      {words({"--factors", "exact"}), "--factors", needs},
      {words({"--closure", "enforce"}), "--closure", needs},
      {words({"--solver", "jacobi"}), "--solver", needs},
      {words({"--gradient", "0.5"}), "--gradient", needs},
      {plain({"--deviation", "0.01"}), "--deviation", "has no part where no curves"},
      {plain({"--events", "ev"}), "--events", "has no part"},
      {plain({"--secondary", "1"}), "--secondary", "has no part"},
      {plain({"--force", "eee"}), "--force", "finds no curves"},
      {plain({"--force", "factors,discontinuities"}), "--force", "finds no curves"},
      {words({"--direct-light", "matrix", "--order", "1"}), "--order", "is of direct light"},
      {words({"--direct-light", "matrix", "--events", "ev"}), "--events", "is of direct light"},
      {matrix({"--order", "3"}), "--order", of_matrix},
      {matrix({"--max-unknowns", "10"}), "--max-unknowns", of_matrix},
      {matrix({"--refine", "adaptive"}), "--refine", of_matrix},
      {matrix({"--visibility", "exact"}), "--visibility", of_matrix},
      {matrix({"--factors", "exact", "--rays", "3"}), "--rays", "is for --factors rays"},
      {matrix({"--hemicube", "8"}), "--hemicube", "is for --factors hemicube"},
      {matrix({"--gradient", "0.5"}), "--gradient", "says what --subdivide"},
      {matrix({"--solver", "jacobi", "--bounces", "1"}), "--solver", "has no part"},
  });
}

TEST_F(IdleOptions, WordsForWhatIsDoneAnywayAreFine) {
  const CommandWords few = {"--method", "matrix", "--elements", "20"};
  for (const CommandWords& more : {CommandWords{"--refine", "uniform"},
                                   {"--order", "0"},
                                   {"--visibility", "Auto"},
                                   {"--final-gather", "off"},
                                   {"--linear"},
                                   {"--direct-light", "matrix", "--events", "contact"},
                                   {"--no-discontinuity", "--force", "factors"}}) {
    CommandWords words = few;
    words.insert(words.end(), more.begin(), more.end());
    words.insert(words.begin(), {"solve", s1_});
    expect_nothing_noted(words);
  }
  expect_nothing_noted({"solve", s1_, "--closure", "auto", "--tolerance", "0.1"});
  EXPECT_EQ(run({"solve", s1_, "-q", "--rays", "5"}).err, "");
}

TEST_F(IdleOptions, OfOtherCommandsAreTold) {
  ASSERT_EQ(run({"solve", s1_, "-q", "--tolerance", "0.2", "-o", "a.vtu"}).exit_code, 0);
  const std::string points = test::data_file("s1_points.csv").string();
  const auto factors = [&](CommandWords more) {
    more.insert(more.begin(), {"factors", s1_, "-o", "f.csv"});
    return more;
  };
  const auto render = [](const std::string& input, CommandWords more) {
    more.insert(more.begin(), {"render", input, "-o", "a.png", "--width", "30", "--height", "20"});
    return more;
  };
  expect_noted({
      {{"probe", s1_, "--points", points, "-o", "p.csv", "--samples", "5"},
       "--samples",
       "is for random walks"},
      {factors({"--rays", "10"}), "--rays", "is for --method rays or hemicube"},
      {factors({"--hemicube", "4"}), "--hemicube", "is for --method hemicube"},
      {factors({"--method", "rays", "--rays", "9", "--hemicube", "4"}), "--hemicube",
       "is for --method hemicube"},
      {factors({"--method", "rays", "--rays", "9", "--max-points", "4"}), "--max-points",
       "is for --method exact"},
      {factors({"--method", "rays", "--rays", "9", "--tolerance", ".1"}), "--tolerance",
       "has no part in a number of --rays"},
      {factors({"--method", "hemicube", "--tolerance", ".1"}), "--tolerance",
       "is for --method exact"},
      {render("a.vtu", {"--fov", "20"}), "--fov", "is of a camera that --position"},
      {render("a.vtu", {"--exponent", "20"}), "--exponent", "is of a lobe"},
      {render("a.vtu", {"--flip"}), "--flip", "is for scenes"},
      {render("a.vtu", {"--orient"}), "--orient", "is for scenes"},
      {render("a.vtu", {"--materials", "m.json"}), "--materials", "is for scenes"},
      {render("a.vtu", {"--compare", "a.vtu", "--exposure", "3"}), "--exposure", "is of the light"},
      {render(s1_, {"--method", "reference", "--flat"}), "--flat", "has no part in traced rays"},
      {render(s1_, {"--method", "classic", "--exponent", "3"}), "--exponent", "is of a lobe"},
      {{"mesh", s1_, "--curves", "c.vtp", "--deviation", ".01"}, "--deviation", "is of elements"},
      {{"mesh", s1_, "--curves", "c.vtp", "--max-length", ".1"}, "--max-length", "is of elements"},
      {{"explain", s1_, "--elements", "50"}, "--elements", "is for constant elements"},
      {{"explain", s1_, "--rays", "5"}, "--rays", "is for constant elements"},
      {{"explain", s1_, "--method", "matrix", "--visibility", "exact"},
       "--visibility",
       "has no part"},
  });
  const CommandWords fine[] = {
      render("a.vtu", {"--compare", "a.vtu", "--exposure", "3", "--side-by-side"}),
      render("a.vtu", {"--gloss", "0.2", "--exponent", "3"}),
      {"mesh", s1_, "--curves", "c.vtp", "--max-length", ".1", "--tolerance", "0.1"},
      {"mesh", s1_, "--curves", "c.vtp", "--max-length", ".5", "--json", "m.json"},
      {"explain", s1_, "--method", "matrix", "--elements", "50"}};
  for (const CommandWords& words : fine) expect_nothing_noted(words);
}

TEST_F(IdleOptions, ExplainNamesTheOptionThatAllowsMoreElements) {
  // Squares upright across each other: contact lines grow with the square of their number.
  std::string obj =
      "mtllib s.mtl\nusemtl lamp\nv -1 -1 9\nv -1 2 9\nv 2 2 9\nv 2 -1 9\nf 1 2 3 4\n";
  obj += "usemtl grey\n";
  int vertices = 4;
  const int each = 12;
  for (int k = 0; k < 2 * each; ++k) {
    const std::string at = std::to_string((k / 2 + 0.5) / each);
    for (const auto& [u, z] : {std::pair{"0", "0"}, {"1", "0"}, {"1", "1"}, {"0", "1"}})
      obj += k % 2 == 0 ? "v " + at + " " + u + " " + z + "\n"
                        : "v " + (u + (" " + at)) + " " + z + "\n";
    obj += "f";
    for (int c = 0; c < 4; ++c) obj += " " + std::to_string(++vertices);
    obj += "\n";
  }
  folder_.write("s.obj", obj);
  folder_.write("s.mtl", "newmtl lamp\nKd 0 0 0\nKe 1 1 1\nnewmtl grey\nKd .5 .5 .5\n");
  const test::Outcome few = run({"explain", "s.obj", "--max-elements", "100"});
  EXPECT_EQ(few.exit_code, 0);
  EXPECT_NE(few.err.find("more than 100 of them"), std::string::npos) << few.err;
  EXPECT_NE(few.err.find("--max-elements allows more"), std::string::npos) << few.err;
  EXPECT_EQ(run({"explain", "s.obj", "--max-elements", "100000"}).err, "");
  test::expect_sentence(run({"explain", "s.obj", "--max-elements", "10"}), 3,
                        "--max-elements allows more");
}

}  // namespace
}  // namespace halfshade
