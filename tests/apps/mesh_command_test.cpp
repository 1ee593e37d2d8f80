#include "tests/support/files.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <sstream>

namespace halfshade {
namespace {

namespace fs = std::filesystem;

const std::string s1_file = test::data_file("s1.obj").string();
const std::string skew_bars = test::data_file("skew_bars.obj").string();

class Mesh : public testing::Test {
 protected:
  test::Outcome mesh(std::vector<std::string> arguments,
                     std::chrono::milliseconds interrupt_after = {}) {
    arguments.insert(arguments.begin(), {test::program, "mesh"});
    return test::run_program(std::move(arguments), folder_.path(), interrupt_after);
  }
  std::string file(const std::string& name) { return test::contents(folder_.path() / name); }
  nlohmann::json json(const std::string& name) { return nlohmann::json::parse(file(name)); }
  bool exists(const std::string& name) { return fs::exists(folder_.path() / name); }

  test::TempDir folder_;
};

TEST_F(Mesh, WritesMeshCurvesPictureAndReport) {
  const test::Outcome outcome =
      mesh({s1_file, "-o", "m.vtu", "-o", "m.ply", "-o", "m.vtp", "--curves", "c.vtp", "--picture",
            "p.png", "--pixels", "100", "--json", "r.json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  for (const char* name : {"m.vtu", "m.ply", "m.vtp", "c.vtp", "p.png"}) {
    EXPECT_TRUE(exists(name)) << name;
    EXPECT_NE(outcome.out.find(name), std::string::npos);
  }
  const auto report = json("r.json");
  EXPECT_FALSE(report.at("interrupted").get<bool>());
  EXPECT_GT(report.at("curves").at("total"), 0);
  EXPECT_EQ(report.at("mesh").at("culled"), 0) << "complete unless a tolerance is given";
  EXPECT_EQ(report.at("search").at("complete"), true);
  EXPECT_EQ(report.at("outputs").size(), 5u);
  EXPECT_GE(report.at("mesh").at("area_quality").at("good"), 0.99);
}

TEST_F(Mesh, DrawsConicsAsCloselyAsAsked) {
  std::size_t elements = 0;
  for (const char* deviation : {"1e-3", "1e-5", "1e-7"}) {
    const test::Outcome outcome =
        mesh({skew_bars, "-q", "-o", "m.vtu", "--deviation", deviation, "--json", "r.json"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto report = json("r.json").at("mesh");
    // Of a floor whose diagonal is below 10, with what snapping adds.
    EXPECT_LT(report.at("deviation").get<double>(), 12 * std::stod(deviation));
    EXPECT_GT(report.at("deviation"), 0);
    EXPECT_NE(file("m.vtu").find("Name=\"curve_deviation\""), std::string::npos);
    EXPECT_GT(report.at("elements"), elements);
    elements = report.at("elements");
  }
  EXPECT_EQ(mesh({skew_bars, "--deviation", "0.2"}).exit_code, 2);
}

TEST_F(Mesh, FindsTheLimitsOfS1) {
  // Four lines limit the umbra, |x|, |y| = 0.25, four the penumbra, |x|, |y| = 1.25, each D1.
  ASSERT_EQ(mesh({s1_file, "--curves", "c.vtp", "--json", "r.json", "-q"}).exit_code, 0);
  const auto orders = json("r.json").at("curves").at("by_order");
  EXPECT_EQ(orders.count("D0"), 0u);
  // The lines x = ±0.25 from |y| ≤ 1.25 on and so on: 4 × 2 × 2.5 in all.
  EXPECT_NEAR(orders.at("D1").at("length").get<double>(), 20, 1e-9);
}

TEST_F(Mesh, WithoutOutputsItIsNamedAfterTheScene) {
  ASSERT_EQ(mesh({s1_file, "-q"}).exit_code, 0);
  EXPECT_TRUE(exists("s1.vtu"));
}

TEST_F(Mesh, OnlyWhatIsAskedForIsMade) {
  ASSERT_EQ(mesh({s1_file, "--curves", "c.vtp", "-q"}).exit_code, 0);
  EXPECT_TRUE(exists("c.vtp"));
  EXPECT_FALSE(exists("s1.vtu"));
}

TEST_F(Mesh, EventsChooseTheKinds) {
  const auto kinds = [&](const std::string& events) {
    EXPECT_EQ(mesh({skew_bars, "--events", events, "--json", "r.json", "-q", "--curves", "c.vtp"})
                  .exit_code,
              0);
    return json("r.json").at("curves").at("by_kind");
  };
  EXPECT_EQ(kinds("eee").size(), 1u);
  EXPECT_EQ(kinds("eee").count("eee"), 1u);
  EXPECT_EQ(kinds("contact,face,ev").count("eee"), 0u);
  EXPECT_GT(kinds("face,ev").at("ev").at("count"), 0);
  const auto all = kinds("contact,face,ev,eee");
  ASSERT_EQ(mesh({skew_bars, "--json", "r.json", "-q", "--curves", "c.vtp"}).exit_code, 0);
  EXPECT_EQ(json("r.json").at("curves").at("by_kind"), all) << "all is the default";
}

TEST_F(Mesh, ToleranceLeavesOutAndMaxLengthRefines) {
  const auto run = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {skew_bars, "--json", "r.json", "-q", "-o", "m.vtu"});
    EXPECT_EQ(mesh(more).exit_code, 0);
    return json("r.json").at("mesh");
  };
  const auto complete = run({}), coarse = run({"--tolerance", "0.5"}),
             fine = run({"--max-length", "0.2"});
  EXPECT_EQ(complete.at("culled"), 0);
  EXPECT_EQ(complete.at("irradiance_tolerance_w_per_m2"), 0);
  EXPECT_GT(coarse.at("irradiance_tolerance_w_per_m2"), 0);
  EXPECT_GT(coarse.at("culled"), 0);
  EXPECT_LT(coarse.at("elements"), complete.at("elements"));
  EXPECT_LE(fine.at("longest_edge"), 0.2);
  EXPECT_GT(fine.at("elements"), complete.at("elements"));
}

TEST_F(Mesh, SecondarySourcesHaveCurvesOfTheirOwn) {
  const std::string box = test::data_file("cornell_box.obj").string();
  const auto run = [&](const std::string& secondary) {
    EXPECT_EQ(mesh({box, "--secondary", secondary, "--events", "contact,face", "--json", "r.json",
                    "-q", "--tolerance", "0.5"})
                  .exit_code,
              0);
    return json("r.json");
  };
  const auto without = run("0"), with = run("1");
  EXPECT_EQ(with.at("sources").size(), without.at("sources").size() + 1);
  EXPECT_EQ(without.at("sources").at(0), with.at("sources").at(0));
  EXPECT_NE(with.at("sources").back().at("group"), "light");
  EXPECT_GT(with.at("sources").back().at("exitance_w_per_m2"), 0);
}

TEST_F(Mesh, ThreadsDoNotChangeTheBytes) {
  const auto body = [&](const std::string& threads) {
    EXPECT_EQ(mesh({skew_bars, "-q", "--threads", threads, "-o", "m.ply", "--picture", "p.png",
                    "--pixels", "64"})
                  .exit_code,
              0);
    const std::string text = file("m.ply");
    return text.substr(text.find("end_header")) + file("p.png");
  };
  EXPECT_EQ(body("1"), body("2"));
}

TEST_F(Mesh, QuietIsQuiet) {
  const test::Outcome outcome = mesh({s1_file, "-q", "-o", "m.vtu", "--picture", "p.png"});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
}

TEST_F(Mesh, InterruptWritesWhatThereIsMarked) {
  const test::Outcome outcome = mesh({test::data_file("hundred_lights.obj").string(), "--curves",
                                      "c.vtp", "-o", "m.vtu", "--json", "r.json"},
                                     std::chrono::milliseconds(1500));
  EXPECT_EQ(outcome.exit_code, 130);
  EXPECT_NE(outcome.err.find("interrupted: "), std::string::npos) << outcome.err;
  EXPECT_TRUE(json("r.json").at("interrupted").get<bool>());
  EXPECT_TRUE(exists("c.vtp"));
  EXPECT_TRUE(exists("m.vtu"));
}

TEST_F(Mesh, ExamplesOfTheHelpRun) {
  fs::create_directory_symlink(test::data_folder, folder_.path() / "data");
  const auto examples = test::examples_of(mesh({"--help"}).out, "mesh");
  EXPECT_GE(examples.size(), 4u);
  for (const std::vector<std::string>& arguments : examples) {
    const test::Outcome outcome = mesh(arguments);
    EXPECT_EQ(outcome.exit_code, 0) << testing::PrintToString(arguments) << outcome.err;
  }
  for (const char* name : {"s1_mesh.vtu", "s1_curves.vtp", "skew_bars.png", "bars.vtp"})
    EXPECT_TRUE(exists(name)) << name;
}

TEST_F(Mesh, SaysInOneSentenceWhatIsWrong) {
  std::ofstream(folder_.path() / "dark.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  struct Wrong {
    std::vector<std::string> arguments;
    int exit_code;
    std::string names;
  };
  const std::vector<Wrong> all = {
      {{"none.obj", "-o", "m.vtu"}, 3, "none.obj"},
      {{"dark.obj", "-o", "m.vtu"}, 3, "emit"},
      {{s1_file, "-o", "m.obj"}, 2, ".obj"},
      {{s1_file, "--curves", "c.vtu"}, 2, ".vtu"},
      {{s1_file, "--picture", "p.jpg"}, 2, ".jpg"},
      {{s1_file, "--picture", "p.png", "--of", "roof"}, 2, "roof"},
      {{s1_file, "--picture", "p.png", "--of", "7"}, 2, "'7'"},
      {{s1_file, "-o", "none/m.vtu"}, 5, "none"},
      {{s1_file, "--curves", "none/c.vtp"}, 5, "none"},
      {{s1_file, "--picture", "none/p.png"}, 5, "none"},
      {{s1_file, "--json", "none/r.json", "-o", "m.vtu"}, 5, "none"},
  };
  for (const Wrong& wrong : all) {
    test::expect_sentence(mesh(wrong.arguments), wrong.exit_code, wrong.names);
    for (const char* name : {"m.vtu", "c.vtp", "p.png"}) EXPECT_FALSE(exists(name));
  }
}

TEST_F(Mesh, RefusesWrongUsage) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{},
        {s1_file, "--events", "penumbra"},
        {s1_file, "--tolerance", "-1"},
        {s1_file, "--tolerance", "nan"},
        {s1_file, "--max-length", "0"},
        {s1_file, "--max-length", "nan"},
        {s1_file, "--secondary", "-1"},
        {s1_file, "--of", "receiver"},
        {s1_file, "--picture", "p.png", "--colour", "red"},
        {s1_file, "--picture", "p.png", "--pixels", "0"}}) {
    const test::Outcome outcome = mesh(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find("--help"), std::string::npos) << outcome.err;
    EXPECT_FALSE(exists("s1.vtu"));
  }
}

TEST_F(Mesh, OfVeryManySurfacesIsCompleteOnlyIfToldSo) {
  std::ofstream scene(folder_.path() / "many.obj");
  scene << "mtllib many.mtl\nusemtl lamp\nv 0 0 9\nv 0 1 9\nv 1 1 9\nv 1 0 9\nf 1 2 3 4\n"
           "usemtl dark\n";
  for (int k = 0; k < 20100; ++k)
    scene << "v " << k % 150 << " " << k / 150 << " 0\nv " << k % 150 + .5 << " " << k / 150
          << " 0\nv " << k % 150 << " " << k / 150 + .5 << " .3\nf -3 -2 -1\n";
  scene.close();
  std::ofstream(folder_.path() / "many.mtl") << "newmtl lamp\nKd 0 0 0\nKe 1 1 1\n"
                                                "newmtl dark\nKd 0 0 0\n";
  const test::Outcome refused = mesh({"many.obj", "-q", "-o", "m.vtu"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("--tolerance 0.01"), std::string::npos) << refused.err;
  EXPECT_FALSE(exists("m.vtu"));
  const test::Outcome contacts = mesh({"many.obj", "-q", "-o", "m.vtu", "--events", "contact"});
  EXPECT_EQ(contacts.exit_code, 0) << contacts.err;
}

}  // namespace
}  // namespace halfshade
