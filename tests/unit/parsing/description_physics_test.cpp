// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "server/description/experiment.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// Tests of reading surfaces, materials, and settings of physics.
namespace cohort::description {
namespace {

const std::string ball = "<sphere><radius>1</radius></sphere>";

std::string made_of(const std::string& material, const std::string& name = "m") {
  return static_model_sdf(collision(ball, "\n<cohort:material>" + material + "</cohort:material>"), name);
}
std::string pair(const std::string& first, const std::string& second, const std::string& rest = "") {
  return "\n<cohort:material_pair>\n<cohort:first>" + first + "</cohort:first>\n<cohort:second>" + second +
         "</cohort:second><cohort:friction>0.4</cohort:friction>" + rest + "</cohort:material_pair>";
}
const Surface& surface_of(const World& world, std::size_t model) {
  return world.models[model].links[0].collisions[0].surface;
}

std::string contact(const std::string& content) {
  return static_model_sdf(collision(ball, "<surface>\n<contact>" + content + "</contact></surface>"));
}

using Surfaces = Description;

TEST_F(Surfaces, ReadRollingResistanceFromBullet) {
  const World world = read(static_model_sdf(
      collision(ball,
                "<surface><friction><ode><mu>0.3</mu></ode><bullet><rolling_friction>0.002</rolling_friction>"
                "</bullet></friction></surface>")));
  EXPECT_EQ(surface_of(world, 0).friction, 0.3);
  EXPECT_EQ(surface_of(world, 0).rolling_resistance, 0.002);
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  EXPECT_EQ(surface_of(read(static_model_sdf(collision(ball, "<surface><friction><bullet/></friction></surface>"))), 0)
                .rolling_resistance,
            0.0);
}

TEST_F(Surfaces, ReadStiffnessAndDampingFromOdeOrBullet) {
  for (const char* const content : {"<ode><kp>2e5</kp><kd>30</kd></ode>", "<bullet><kp>2e5</kp><kd>30</kd></bullet>"}) {
    const World world = read(contact(content));
    EXPECT_EQ(surface_of(world, 0).stiffness, 2e5);
    EXPECT_EQ(surface_of(world, 0).damping, 30.0);
    EXPECT_EQ(texts_of(world.warnings).find("kp"), std::string::npos) << texts_of(world.warnings);
  }
  const World world = read(contact("<ode><max_vel>0.1</max_vel><min_depth>0.001</min_depth><kp>1e6</kp></ode>"));
  EXPECT_EQ(world.warnings.size(), 2u) << texts_of(world.warnings);
  EXPECT_EQ(surface_of(world, 0).damping, 1.0);  // SDF's default
}

std::string bounce(const std::string& content) {
  return static_model_sdf(collision(ball, "<surface>\n<bounce>" + content + "</bounce></surface>"));
}

TEST_F(Surfaces, ReadTheBounceThreshold) {
  const World world = read(bounce("<threshold>0.3</threshold>"));
  EXPECT_EQ(surface_of(world, 0).bounce_threshold, 0.3);
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  EXPECT_FALSE(surface_of(read(bounce("")), 0).bounce_threshold);
}

std::string friction(const std::string& content) {
  return static_model_sdf(collision(ball, "<surface><friction>" + content + "</friction></surface>"));
}

TEST_F(Surfaces, ReadFrictionAlongAndAcrossADirection) {
  for (const char* const content : {"<ode><mu>0.3</mu><mu2>0.7</mu2><fdir1>0 2 0</fdir1></ode>",
                                    "<bullet><friction>0.3</friction><friction2>0.7</friction2><fdir1>0 1 0</fdir1>"
                                    "</bullet>"}) {
    const World world = read(friction(content));
    EXPECT_EQ(surface_of(world, 0).friction, 0.3);
    EXPECT_EQ(surface_of(world, 0).second_friction, 0.7);
    EXPECT_EQ(surface_of(world, 0).friction_direction, Eigen::Vector3d::UnitY());
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  }
  for (const char* const content : {"<ode><mu>0.3</mu><mu2>0.7</mu2></ode>",
                                    "<bullet><friction>0.3</friction><friction2>0.7</friction2></bullet>"}) {
    const World world = read(friction(content));
    EXPECT_FALSE(surface_of(world, 0).has_direction());
    EXPECT_NE(texts_of(world.warnings).find("without <fdir1> friction is the same"), std::string::npos);
  }
}

TEST_F(Surfaces, WarnOfFrictionOfBulletBesideOde) {
  const World world =
      read(static_model_sdf(collision(ball,
                                      "<surface><friction><ode><mu>0.3</mu></ode><bullet><friction>0.5</"
                                      "friction><friction2>0.5</friction2><fdir1>1 0 0</fdir1>"
                                      "</bullet></friction></surface>")));
  const std::string all = texts_of(world.warnings);
  EXPECT_EQ(world.warnings.size(), 3u) << all;
  for (const char* const name : {"bullet/friction: ", "bullet/friction2: ", "bullet/fdir1: "})
    EXPECT_NE(all.find(name), std::string::npos) << all;
}

TEST_F(Surfaces, ReadBitmasksOf16Bits) {
  const auto bits = [&](const std::string& content) {
    const World world = read(contact(content));
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
    return std::pair<int, int>(surface_of(world, 0).category_bitmask, surface_of(world, 0).collide_bitmask);
  };
  EXPECT_EQ(bits(""), std::pair(0xFFFF, 0xFFFF));
  EXPECT_EQ(bits("<collide_bitmask>0x0A</collide_bitmask>"), std::pair(10, 10));
  EXPECT_EQ(bits("<collide_bitmask>0xFFFF0001</collide_bitmask>"), std::pair(1, 1));
  EXPECT_EQ(bits("<collide_bitmask>3</collide_bitmask><category_bitmask>0x4</category_bitmask>"), std::pair(4, 3));
}

std::string torsional(const std::string& content) {
  return static_model_sdf(
      collision(ball, "<surface><friction><torsional>" + content + "</torsional></friction></surface>"));
}

TEST_F(Surfaces, ComputeSpinningResistanceFromTheContactPatch) {
  const World world = read(torsional("<coefficient>0.4</coefficient><patch_radius>0.03</patch_radius>"));
  EXPECT_NEAR(surface_of(world, 0).spinning_resistance, 3.0 * M_PI / 16.0 * 0.03 * 0.4, 1e-15);
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  EXPECT_EQ(surface_of(read(torsional("<coefficient>0.4</coefficient>")), 0).spinning_resistance, 0.0);
  const World by_depth =
      read(torsional("<use_patch_radius>false</use_patch_radius><surface_radius>0.1</surface_radius>"));
  EXPECT_EQ(surface_of(by_depth, 0).spinning_resistance, 0.0);
  EXPECT_NE(texts_of(by_depth.warnings).find("a contact patch that grows with depth"), std::string::npos);
}

TEST_F(Surfaces, ReadLinksWithoutGravity) {
  const auto link = [](const std::string& content) {
    return "<model name=\"m\"><link name=\"l\">" + content +
           "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link></model>";
  };
  for (const auto& [content, feels_gravity] :
       {std::pair("", true), std::pair("<gravity>true</gravity>", true), std::pair("<gravity>0</gravity>", false)}) {
    const World world = read(link(content));
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
    EXPECT_EQ(world.models[0].links[0].feels_gravity, feels_gravity) << content;
  }
}

TEST_F(Surfaces, ReadKinematicLinksIfTheyAreFree) {
  const auto two_links = [](const std::string& of_a, const std::string& of_b, const std::string& parent) {
    const std::string inertial =
        "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>";
    return "<model name=\"m\">\n<link name=\"a\">" + of_a + inertial + "<link name=\"b\">" + of_b + inertial +
           "<joint name=\"j\" type=\"revolute\"><parent>" + parent +
           "</parent><child>b</child><axis><xyz>0 0 1</xyz></axis></joint></model>";
  };
  const World world = read(two_links("<kinematic>true</kinematic>", "<kinematic>false</kinematic>", "a"));
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  EXPECT_TRUE(world.models[0].links[0].is_kinematic);
  EXPECT_FALSE(world.models[0].links[1].is_kinematic);
  const World held = read(two_links("", "<kinematic>true</kinematic>", "a"));
  EXPECT_FALSE(held.models[0].links[1].is_kinematic);
  EXPECT_NE(
      texts_of(held.warnings).find("<kinematic> of the link 'b' is ignored because the link is attached by a joint"),
      std::string::npos)
      << texts_of(held.warnings);
}

TEST_F(Surfaces, NumberMaterialsInOrderOfAppearance) {
  const World world = read(made_of("rubber", "a") + made_of("wood", "b") + made_of("rubber", "c") +
                           static_model_sdf(collision(ball), "d") +
                           pair("wood", "rubber", "<cohort:restitution>0.1</cohort:restitution>") +
                           pair("rubber", "rubber", "<cohort:rolling_resistance>0.01</cohort:rolling_resistance>"));
  EXPECT_EQ(world.materials, (std::vector<std::string>{"", "rubber", "wood"}));
  EXPECT_EQ(surface_of(world, 0).material, 1u);
  EXPECT_EQ(surface_of(world, 1).material, 2u);
  EXPECT_EQ(surface_of(world, 2).material, 1u);
  EXPECT_EQ(surface_of(world, 3).material, 0u);
  ASSERT_EQ(world.material_pairs.size(), 2u);
  EXPECT_EQ(world.material_pairs[0].first, 2u);
  EXPECT_EQ(world.material_pairs[0].second, 1u);
  EXPECT_EQ(world.material_pairs[0].friction, 0.4);
  EXPECT_EQ(world.material_pairs[0].restitution, 0.1);
  EXPECT_EQ(world.material_pairs[0].rolling_resistance, 0.0);
  EXPECT_EQ(world.material_pairs[1].restitution, 0.0);
  EXPECT_EQ(world.material_pairs[1].rolling_resistance, 0.01);
}

TEST_F(Surfaces, ReadMaterialsOfIncludedModels) {
  write_model("tyre",
              made_of("rubber").substr(std::string("<model name=\"m\">").size(),
                                       made_of("rubber").size() - std::string("<model name=\"m\"></model>").size()));
  const World world = read("<include><uri>model://tyre</uri></include>" + pair("rubber", "rubber"));
  EXPECT_EQ(world.material_pairs.size(), 1u);
}

using PhysicsOfAWorld = Description;

std::string physics(const std::string& keys) { return "<cohort:physics>\n" + keys + "</cohort:physics>"; }

TEST_F(PhysicsOfAWorld, HasTheDefaultsOfTheManual) {
  for (const std::string& content : {std::string(), physics("")}) {
    const PhysicsSettings settings = read(content).physics;
    EXPECT_EQ(settings.fidelity, Fidelity::treel);
    EXPECT_EQ(settings.solver, Solver::convex);
    EXPECT_EQ(settings.iterations, 10u);
    EXPECT_EQ(settings.direct_bodies, 4u);
    EXPECT_EQ(settings.lowest, -std::numeric_limits<double>::infinity());
    EXPECT_FALSE(settings.strict);
  }
}

TEST_F(PhysicsOfAWorld, ReadsAllSettings) {
  const PhysicsSettings settings =
      read(physics("<cohort:fidelity>articulated</cohort:fidelity><cohort:solver>hybrid</cohort:solver>"
                   "<cohort:iterations>50</cohort:iterations><cohort:direct_bodies>8</cohort:direct_bodies>"
                   "<cohort:lowest>-2.5</cohort:lowest><cohort:strict>true</cohort:strict>"))
          .physics;
  EXPECT_EQ(settings.fidelity, Fidelity::articulated);
  EXPECT_EQ(settings.solver, Solver::hybrid);
  EXPECT_EQ(settings.iterations, 50u);
  EXPECT_EQ(settings.direct_bodies, 8u);
  EXPECT_EQ(settings.lowest, -2.5);
  EXPECT_TRUE(settings.strict);
  EXPECT_EQ(
      read(physics("<cohort:fidelity>planar</cohort:fidelity><cohort:solver>direct</cohort:solver>")).physics.fidelity,
      Fidelity::planar);
}

class FlawOfASurface : public Description, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfASurface, IsReportedAloneWithFileLineAndElement) {
  expect_only_flaw(GetParam(), write_world(GetParam().content));
}

const std::string in_collision = "world/model[m]/link[l]/collision[c]";
const std::string in_pair = "world/cohort:material_pair";
const std::string in_physics = "world/cohort:physics";

INSTANTIATE_TEST_SUITE_P(
    Surfaces, FlawOfASurface,
    testing::Values(
        Flaw{static_model_sdf(collision(
                 ball,
                 "<surface><friction><bullet>\n<rolling_friction>-1</rolling_friction></bullet></friction></surface>")),
             3, in_collision + "/surface/friction/bullet/rolling_friction", "expected a rolling resistance >= 0 m"},
        Flaw{contact("<collide_bitmask>0xG</collide_bitmask>"), 3, in_collision + "/surface/contact/collide_bitmask",
             "'0xG'"},
        Flaw{torsional("\n<patch_radius>-1</patch_radius>"), 3,
             in_collision + "/surface/friction/torsional/patch_radius", "cannot have the value '-1'"},
        Flaw{friction("<ode>\n<mu2>-1</mu2></ode>"), 3, in_collision + "/surface/friction/ode/mu2",
             "cannot have the value '-1'"},
        Flaw{friction("<bullet>\n<fdir1>1 0</fdir1></bullet>"), 3, in_collision + "/surface/friction/bullet/fdir1",
             "1 0"},
        Flaw{contact("<ode><kp>0</kp></ode>"), 3, in_collision + "/surface/contact/ode/kp",
             "expected a stiffness > 0 N/m"},
        Flaw{contact("<ode><kd>-1</kd></ode>"), 3, in_collision + "/surface/contact/ode/kd",
             "expected a damping >= 0 N s/m"},
        Flaw{bounce("<threshold>-1</threshold>"), 3, in_collision + "/surface/bounce/threshold",
             "expected a velocity >= 0 m/s"},
        Flaw{torsional("\n<coefficient>-1</coefficient>"), 3, in_collision + "/surface/friction/torsional/coefficient",
             "cannot have the value '-1'"},
        Flaw{made_of(" "), 3, in_collision + "/cohort:material", "expected a name"},
        Flaw{made_of("<cohort:name>x</cohort:name>"), 3, in_collision + "/cohort:material/cohort:name",
             "must contain a name"},
        Flaw{made_of("a</cohort:material>\n<cohort:material>b"), 4, in_collision + "/cohort:material", "given twice"},
        Flaw{static_model_sdf(collision(ball, "\n<cohort:materiel>a</cohort:materiel>")), 3,
             in_collision + "/cohort:materiel", "did you mean 'cohort:material'?"},
        Flaw{static_model_sdf("\n<cohort:material>a</cohort:material>" + collision(ball)), 3,
             "world/model[m]/cohort:material", "must be in <collision>"},
        Flaw{made_of("rubber") + pair("ruber", "rubber"), 5, in_pair + "/cohort:first",
             "no collision has the material 'ruber'; did you mean 'rubber'?"},
        Flaw{made_of("rubber") + pair("rubber", "steel"), 6, in_pair + "/cohort:second",
             "no collision has the material 'steel'; known: rubber"},
        Flaw{made_of("rubber") + made_of("wood", "n") + pair("rubber", "wood") + pair("wood", "rubber"), 8, in_pair,
             "there is already a <cohort:material_pair> for 'wood' and 'rubber'"},
        Flaw{made_of("rubber") + pair("rubber", "rubber", "<cohort:restitution>1.5</cohort:restitution>"), 6,
             in_pair + "/cohort:restitution", "expected a number from 0 to 1, not '1.5'"},
        Flaw{made_of("rubber") + "\n<cohort:material_pair><cohort:first>rubber</cohort:first><cohort:second>rubber</"
                                 "cohort:second></cohort:material_pair>",
             4, in_pair + "/cohort:friction", "missing"},
        Flaw{physics("<cohort:fidelity>artculated</cohort:fidelity>"), 3, in_physics + "/cohort:fidelity",
             "unknown value 'artculated'; did you mean 'articulated'?"},
        Flaw{physics("<cohort:solver>x</cohort:solver>"), 3, in_physics + "/cohort:solver",
             "known: iterative, convex, direct, hybrid"},
        Flaw{physics("<cohort:solver/>"), 3, in_physics + "/cohort:solver",
             "expected one of iterative, convex, direct, hybrid"},
        Flaw{physics("<cohort:iterations>0</cohort:iterations>"), 3, in_physics + "/cohort:iterations", "from 1 to"},
        Flaw{physics("<cohort:lowest>inf</cohort:lowest>"), 3, in_physics + "/cohort:lowest",
             "expected a number, not 'inf'"},
        Flaw{physics("<cohort:strict>yes</cohort:strict>"), 3, in_physics + "/cohort:strict",
             "expected true or false, not 'yes'"},
        Flaw{physics("<cohort:solvr>direct</cohort:solvr>"), 3, in_physics + "/cohort:solvr",
             "did you mean 'cohort:solver'?"},
        Flaw{physics("") + physics(""), 3, in_physics, "given twice"}));

class PhysicsOfAnExperiment : public Description {
 protected:
  PhysicsOfAnExperiment() {
    write_world("<include><uri>model://sbot</uri></include>" +
                physics("<cohort:solver>direct</cohort:solver><cohort:iterations>20</cohort:iterations>"));
  }
  std::filesystem::path write_experiment(const std::string& settings) const {
    return write("e.yaml",
                 "world: world.sdf\nduration: 1\nteams: [{name: a, controller: x, robots: all}]\n" + settings);
  }
};

TEST_F(PhysicsOfAnExperiment, OverridesSingleKeysOfTheWorld) {
  EXPECT_EQ(parsing::read_experiment(write_experiment("")).world.physics.iterations, 20u);
  const PhysicsSettings settings =
      parsing::read_experiment(
          write_experiment("physics:\n  iterations: 30\n  fidelity: planar\n  strict: true\n  lowest: -1\n"))
          .world.physics;
  EXPECT_EQ(settings.solver, Solver::direct);
  EXPECT_EQ(settings.iterations, 30u);
  EXPECT_EQ(settings.fidelity, Fidelity::planar);
  EXPECT_TRUE(settings.strict);
  EXPECT_EQ(settings.lowest, -1.0);
}

using Accuracy = Description;

TEST_F(Accuracy, AStepThatIsTooLongIsWarnedOf) {
  const auto with_step = [&](const std::string& step) {
    return read("<physics type=\"ignored\"><max_step_size>" + step + "</max_step_size></physics>").warnings;
  };
  EXPECT_TRUE(with_step("0.05").empty());
  const std::vector<Problem> warnings = with_step("0.2");
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].line, 2);
  EXPECT_EQ(warnings[0].element, "world/physics/max_step_size");
  EXPECT_TRUE(warnings[0].message.starts_with("a step of 0.2 s is too long")) << warnings[0].message;
}

TEST_F(Accuracy, AMassRatioThatIsTooGreatIsWarnedOf) {
  const auto of_mass = [](const std::string& name, const std::string& mass) {
    return "<model name=\"" + name + "\"><link name=\"l\"><inertial><mass>" + mass +
           "</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial><collision name=\"c\"><geometry>" +
           ball + "</geometry></collision></link></model>";
  };
  EXPECT_TRUE(read(of_mass("crate", "10") + of_mass("bead", "0.001")).warnings.empty());
  const std::vector<Problem> warnings = read(of_mass("crate", "1000") + of_mass("bead", "0.001")).warnings;
  ASSERT_EQ(warnings.size(), 1u) << texts_of(warnings);
  EXPECT_EQ(warnings[0].element, "model[crate]");
  EXPECT_TRUE(warnings[0].message.starts_with("has 1e+06 times the mass of 'bead'")) << warnings[0].message;
}

TEST_F(Accuracy, AChainThatSwingsTooFastForTheStepIsWarnedOf) {
  const auto chain = [](int count, const std::string& dynamics) {
    std::string model =
        "<model name=\"chain\"><joint name=\"j0\" type=\"revolute\"><parent>world</parent>"
        "<child>l0</child><axis><xyz>0 1 0</xyz>" +
        dynamics + "</axis></joint>";
    for (int i = 0; i < count; ++i) {
      const std::string link = "l" + std::to_string(i);
      model += "<link name=\"" + link + "\"><pose>0 0 " + std::to_string(-0.1 * i) +
               " 0 0 0</pose><inertial><pose>0 0 -0.05 0 0 0</pose><mass>1</mass>"
               "<inertia><ixx>8.3333e-4</ixx><iyy>8.3333e-4</iyy><izz>1e-6</izz></inertia></inertial></link>";
      if (i > 0)
        model += "<joint name=\"j" + std::to_string(i) + "\" type=\"revolute\"><parent>l" + std::to_string(i - 1) +
                 "</parent><child>" + link + "</child><axis><xyz>0 1 0</xyz>" + dynamics + "</axis></joint>";
    }
    return model + "</model>";
  };
  const auto warnings = [&](const std::string& content) {
    std::vector<std::string> texts;
    for (const Problem& warning : read(content).warnings)
      if (warning.message.starts_with("swings")) texts.push_back(warning.message);
    return texts;
  };
  const std::string of_two_milliseconds = "<physics type=\"ignored\"><max_step_size>0.002</max_step_size></physics>";
  EXPECT_EQ(warnings(chain(7, "")),
            std::vector<std::string>{
                "swings on 7 joints in a row that nothing brakes: steps of 0.01 s are too long to keep its energy; "
                "use at most 0.00072 s, or give the joints damping"});
  EXPECT_EQ(warnings(of_two_milliseconds + chain(7, "")), std::vector<std::string>{});
  EXPECT_EQ(warnings(chain(2, "")), std::vector<std::string>{});
  EXPECT_EQ(warnings(chain(7, "<dynamics><damping>0.1</damping></dynamics>")), std::vector<std::string>{});
  EXPECT_EQ(warnings("<gravity>0 0 0</gravity>" + chain(7, "")), std::vector<std::string>{});
}

class FlawOfPhysicsInAnExperiment : public PhysicsOfAnExperiment, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfPhysicsInAnExperiment, IsReportedAloneWithFileLineAndKey) {
  const std::filesystem::path file = write_experiment(GetParam().content);
  const auto problems = problems_of([&] { parsing::read_experiment(file); });
  expect_problem(problems, file, GetParam());
  EXPECT_EQ(problems.size(), 1u);
}

INSTANTIATE_TEST_SUITE_P(
    Experiments, FlawOfPhysicsInAnExperiment,
    testing::Values(Flaw{"physics: 3\n", 4, "physics", "expected 'KEY: VALUE' lines, not '3'"},
                    Flaw{"physics:\n  solvr: direct\n", 5, "physics.solvr", "did you mean 'solver'?"},
                    Flaw{"physics:\n  solver: dircet\n", 5, "physics.solver",
                         "unknown value 'dircet'; did you mean 'direct'?"},
                    Flaw{"physics:\n  iterations: 0\n", 5, "physics.iterations", "from 1 to 1000000, not '0'"},
                    Flaw{"physics:\n  strict: [true]\n", 5, "physics.strict", "expected true or false, not a list"},
                    Flaw{"physics:\n  lowest: deep\n", 5, "physics.lowest", "expected a number, not 'deep'"}));

}  // namespace
}  // namespace cohort::description
