// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/problem/read_problem.h>

#include <gtest/gtest.h>

#include <ostream>
#include <sstream>

using namespace limber;

namespace
{
  /** A scene that is right; each case breaks one thing. */
  const std::string right_scene = R"(
    set Dimension   = 2
    set End time    = 1
    set Bodies      = beam, water
    set Observables = tip, hertz
    set Checks      = swing
    subsection Body beam
      subsection Box
        set Lower corner = 0, 0
        set Upper corner = 1, 1
      end
    end
    subsection Body water
      set Material = newtonian fluid
      subsection Box
        set Lower corner = 2, 0
        set Upper corner = 3, 1
      end
    end
    subsection Grid
      set Upper corner = 4, 2
    end
    subsection Loads
      set Face loads = press
      subsection Face load press
        set Body     = beam
        set Face     = left
        set Pressure = 1
      end
    end
    subsection Contact
      set Pairs = meeting
      subsection Pair meeting
        set Bodies = beam, water
        set Law    = stick
      end
    end
    subsection Observable tip
      set Type      = displacement
      set Body      = beam
      set Location  = 1, 1
      set Direction = y
    end
    subsection Observable hertz
      set Type       = frequency
      set Observable = tip
    end
    subsection Check swing
      set Observable = hertz
      set Reference  = 1
      set Tolerance  = 0.1
    end
    )";
} // namespace



struct BadScene
{
  std::string              name;
  std::vector<std::string> changes;  // as with --set
  std::vector<std::string> expected; // fragments of the message
  std::string              added = "";
};



static std::ostream &
operator<<(std::ostream &out, const BadScene &scene)
{
  return out << scene.name;
}



namespace
{
  std::string
  message_of(const BadScene &scene)
  {
    try
      {
        const SceneFile file(ParameterText{right_scene + scene.added,
                                           FileFormat::prm,
                                           "bad.prm"},
                             scene.changes);
        if (file.dimension() == 2)
          read_problem<2>(file);
        else
          read_problem<3>(file);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }



  unsigned int
  count_words(const std::string &text)
  {
    std::istringstream stream(text);
    std::string        word;
    unsigned int       count = 0;
    while (stream >> word)
      ++count;
    return count;
  }
} // namespace



class BadScenes : public testing::TestWithParam<BadScene>
{};



TEST_P(BadScenes, AreRefusedWithWhatWhereWhyAndRemedy)
{
  const std::string message = message_of(GetParam());
  ASSERT_FALSE(message.empty()) << "The scene was accepted.";
  for (const std::string &fragment : GetParam().expected)
    EXPECT_NE(message.find(fragment), std::string::npos)
      << "expected: " << fragment << "\nin: " << message;

  // Long enough to help, short enough to be read.
  EXPECT_GE(count_words(message), 15u) << message;
  EXPECT_LE(count_words(message), 40u) << message;
}



TEST(BadScene, WithoutBodiesThereIsNothingToMove)
{
  const SceneFile file(ParameterText{"", FileFormat::prm, "empty.prm"});
  EXPECT_THROW(read_problem<2>(file), InputError);
}



TEST(BadScene, TheSceneTheyAreMadeFromIsRight)
{
  EXPECT_EQ(message_of({}), "");
}



namespace
{
  const std::vector<BadScene> bad_forms = {
    {"UnknownEntry",
     {},
     {"'Cell'", "'Grid'", "line", "'Cells'"},
     "subsection Grid\n set Cell = 3, 3\n end"},
    {"EntryOfAnotherSection",
     {},
     {"'Gravity'", "at the top level", "exists in section 'Loads'"},
     "set Gravity = 0, -9.81"},
    {"UnknownSection",
     {},
     {"'Boundary'", "'Boundaries'"},
     "subsection Boundary\n set left = free\n end"},
    {"SectionOfAnUnlistedName",
     {},
     {"'Body sand'", "'Bodies'", "sand"},
     "subsection Body sand\n end"},
    {"NameWithoutSection",
     {"Bodies=beam, watre"},
     {"'Body watre'", "Did you mean 'Body water'?"}},
    {"NameTwice", {"Bodies=beam, beam"}, {"'beam'", "twice", "'Bodies'"}},
    {"EmptyName", {"Bodies=beam,,water"}, {"names separated by commas"}},
    {"SideOfAnotherDimension",
     {},
     {"'front'", "'Boundaries'", "left, right, bottom, top"},
     "subsection Boundaries\n set front = free\n end"},
    {"WordNotKnown",
     {"Method/Transfer=tpic"},
     {"'tpic'",
      "one of pic | flip | apic | aflip | fmpm | xpic. Did you mean 'pic'?",
      "'Method'"}},
    {"NearestWordIsMeant",
     {"Body beam/Material=neo hookaen"},
     {"Did you mean 'neo hookean'?"}},
    {"NearestWordOfAList",
     {"Output/Fields=velocity, presure"},
     {"Did you mean 'pressure'?"}},
    {"NoWordIsNear",
     {"Method/Transfer=beautiful"},
     {"fmpm | xpic, for instance 'flip'"}},
    {"NotANumber", {"End time=soon"}, {"'soon'", "'End time'"}},
    {"EndTimeZero", {"End time=0"}, {"'0'", "a number greater than 0"}},
    {"CellsZero", {"Grid/Cells=0, 4"}, {"'0, 4'", "integers greater than 0"}},
    {"TwoNumbersInThreeDimensions",
     {"Dimension=3"},
     {"3 numbers separated by commas"}},
    {"DimensionFour", {"Dimension=4"}, {"'4'", "set Dimension = 2"}},
    {"NegativeDensity",
     {"Body beam/Linear elastic/Density=-1"},
     {"'-1'", "'Body beam/Linear elastic'"}},
    {"PoissonOutOfRange",
     {"Body beam/Neo hookean/Poisson's ratio=0.5"},
     {"'0.5'", "greater than -1 and less than 0.5", "'0.3'"}},
    {"BulkModulusZero",
     {"Body water/Newtonian fluid/Bulk modulus=0"},
     {"'0'", "or 'auto'"}},
    {"OverrideOfNothing", {"Grid/Size=2"}, {"'Size'", "--set"}}};



  // That there are two bodies is looked at last.
  BadScene
  bad_frame(const std::string              &name,
            const std::vector<std::string> &changes,
            const std::vector<std::string> &expected)
  {
    BadScene scene{name, {"Body beam/Frame=initial"}, expected};
    scene.changes.insert(scene.changes.end(), changes.begin(), changes.end());
    scene.expected.push_back("'Frame = current'");
    return scene;
  }



  const std::vector<BadScene> bad_frames = {
    bad_frame("LiquidInItsInitialFrame",
              {"Body beam/Material=newtonian fluid"},
              {"'newtonian fluid'", "'neo hookean'"}),
    bad_frame("TwoBodiesInTheirInitialFrame", {}, {"one body", "meets"}),
    bad_frame("TreatmentWithoutInitialFrame",
              {"Body beam/Locking treatment=node"},
              {"'node'", "'Locking treatment = assumed strain'"}),
    bad_frame("HourglassControlInTheInitialFrame",
              {"Body beam/Hourglass control=0.1"},
              {"'Hourglass control = 0'"}),
    bad_frame("CheckerboardControlInTheInitialFrame",
              {"Body beam/Locking treatment=cell",
               "Body beam/Checkerboard control=0.1"},
              {"'Checkerboard control = 0'"}),
    bad_frame("HistoryInTheInitialFrame",
              {"Body beam/History=replace"},
              {"'History = keep'"}),
    bad_frame("StressFirstInTheInitialFrame",
              {"Method/Stress update=usf"},
              {"'Stress update = musl'"})};



  const std::vector<BadScene> bad_bodies = {
    {"GridUpsideDown",
     {"Grid/Upper corner=4, -1"},
     {"(4, -1)", "'Upper corner'", "swapped"}},
    {"BoxUpsideDown",
     {"Body beam/Box/Lower corner=2, 0"},
     {"(1, 1)", "'Body beam/Box'"}},
    {"BodyOutsideGrid",
     {"Body beam/Box/Upper corner=1, 2.5"},
     {"'beam'", "beyond the grid", "(4, 2)"}},
    {"CylinderInThePlane",
     {"Body beam/Shape=cylinder"},
     {"cylinder", "two dimensions", "ball"}},
    {"BlockFoldsOver",
     {"Body beam/Shape=block",
      "Body beam/Block/Corners=0, 0; 1, 1; 1, 0; 0, 1"},
     {"folds over", "counterclockwise", "'Body beam/Block'"}},
    {"FittedBall",
     {"Body beam/Shape=ball", "Body beam/Placement=fitted"},
     {"'fitted'", "'ball'", "Placement = cut"}},
    {"PointsAlongEdgesOfCells",
     {"Body beam/Points along edges=3, 3", "Body beam/Placement=regular"},
     {"'3, 3'", "'regular'", "Placement = fitted"}},
    {"MaterialIsNotNamed",
     {"Body beam/Neo hookean/Density=900"},
     {"'Body beam/Neo hookean'",
      "'Material' is 'linear elastic'",
      "set Material = neo hookean"}},
    {"ShapeIsNotNamed",
     {"Body beam/Ball/Radius=0.4"},
     {"'Body beam/Ball'", "'Shape' is 'box'", "set Shape = ball"}},
    {"SideIsNotNamed",
     {"Boundaries/Side left/Velocity=1; 0"},
     {"'left' is 'slip'", "set left = velocity", "'Boundaries'"}},
    {"FormulaShapeWithoutFormula",
     {"Body beam/Shape=formula"},
     {"missing", "'Inside'"}},
    {"UnionWithoutParts", {"Body beam/Shape=union"}, {"missing", "'Shapes'"}},
    {"CheckerboardControlOfNothing",
     {"Body beam/Locking treatment=assumed strain",
      "Body beam/Checkerboard control=0.5"},
     {"'Checkerboard control'",
      "'assumed strain'",
      "Set 'Checkerboard control = 0'"}},
    {"HourglassControlOfNothing",
     {"Body beam/Locking treatment=none", "Body beam/Hourglass control=0.1"},
     {"'Hourglass control'", "'none'", "Set 'Hourglass control = 0'"}},
    {"HistoryAroundNodes",
     {"Body beam/Locking treatment=node",
      "Body beam/History=relax",
      "Body beam/Relaxation time=1"},
     {"'relax'", "'node'", "History = keep"}},
    {"ImplicitWithLiquid",
     {"Method/Time integration=implicit", "Method/Time step=0.1"},
     {"'newtonian fluid'", "implicit", "'Material = neo hookean'"}},
    {"ImplicitWithoutStep",
     {"Method/Time integration=implicit", "Body water/Material=neo hookean"},
     {"'Time step'", "no stability", "thirtieth"}},
    {"QuasiStaticPlasticWithMeansOfShear",
     {"Method/Time integration=quasi-static",
      "Body beam/Material=j2",
      "Body beam/J2/Yield stress=1e5",
      "Body beam/Locking treatment=cell shear",
      "Body water/Material=neo hookean"},
     {"'cell shear'", "tangent", "'Locking treatment = assumed strain'"}},
    {"QuasiStaticFlowByRate",
     {"Method/Time integration=quasi-static",
      "Body beam/Material=j2",
      "Body beam/J2/Yield stress=1e5",
      "Body beam/J2/Viscosity=10",
      "Body beam/Locking treatment=cell",
      "Body water/Material=neo hookean"},
     {"'j2'", "no rate", "'Viscosity'"}},
    {"QuasiStaticWithSplinesInTheCurrentFrame",
     {"Method/Time integration=quasi-static",
      "Method/Kernel=quadratic",
      "Body water/Material=neo hookean"},
     {"'quadratic'", "initial frame alone", "'Kernel = linear'"}},
    {"BodiesThatMeetInTheirInitialFrame",
     {"Method/Time integration=quasi-static",
      "Body beam/Frame=initial",
      "Body water/Frame=initial",
      "Body water/Material=neo hookean"},
     {"'initial'", "meet", "'Contact/Pairs'", "'Frame = current'"}},
    {"QuasiStaticWithCubicSplines",
     {"Method/Time integration=quasi-static",
      "Method/Kernel=cubic",
      "Body water/Material=neo hookean"},
     {"'cubic'", "quadratic splines", "'Kernel = auto'"}},
    {"QuasiStaticWithMeansAroundNodes",
     {"Method/Time integration=quasi-static",
      "Body beam/Locking treatment=node",
      "Body water/Material=neo hookean"},
     {"'node'", "tangent", "'Locking treatment = assumed strain'"}},
    {"QuasiStaticWithScatter",
     {"Method/Time integration=quasi-static",
      "Body beam/Locking treatment=cell",
      "Body beam/History=replace",
      "Body water/Material=neo hookean"},
     {"'replace'", "quasi-static", "'History = keep'"}},
    {"FaultBehindAComponentThatIsNotFinite",
     {"Body beam/Initial velocity=x/x; y/(x^)"},
     {"formula", "cannot be read", "bracket"}},
    {"QuasiStaticWithVelocity",
     {"Method/Time integration=quasi-static",
      "Body beam/Initial velocity=1; 0",
      "Body water/Material=neo hookean"},
     {"'1; 0'", "nothing has a velocity", "'Time integration = implicit'"}},
    {"QuasiStaticWithOrder",
     {"Method/Time integration=quasi-static",
      "Method/Stress update=usf",
      "Body water/Material=neo hookean"},
     {"'usf'", "end of the step", "'Stress update = auto'"}},
    {"QuasiStaticWithTransfer",
     {"Method/Time integration=quasi-static",
      "Method/Transfer=apic",
      "Body water/Material=neo hookean"},
     {"'apic'", "increments", "'Transfer = flip'"}},
    {"QuasiStaticWithDamping",
     {"Method/Time integration=quasi-static",
      "Method/Damping rate=1",
      "Body water/Material=neo hookean"},
     {"Damping rate", "no such damping", "'Damping rate = 0'"}},
    {"QuasiStaticWithFriction",
     {"Method/Time integration=quasi-static",
      "Boundaries/bottom=friction",
      "Boundaries/Side bottom/Friction coefficient=0.3",
      "Body water/Material=neo hookean"},
     {"bottom", "holds or does not", "'bottom = slip'"}},
    {"LoadFactorOfExplicitSteps",
     {"Loads/Load factor=t"},
     {"'Load factor'", "quasi-static", "'Load factor = auto'"}},
    {"LoadFactorOfPlaces",
     {"Loads/Load factor=t*x"},
     {"'t*x'", "'Load factor'", "one factor", "formula of t alone"}},
    {"SemiImplicitWithoutLiquid",
     {"Method/Time integration=semi-implicit",
      "Body water/Material=neo hookean"},
     {"'semi-implicit'", "no liquid", "'newtonian fluid'"}},
    {"SemiImplicitWithPlasticSolid",
     {"Method/Time integration=semi-implicit",
      "Body water/Material=j2",
      "Body water/J2/Yield stress=1e5",
      "Body water/Locking treatment=cell"},
     {"'semi-implicit'", "no elastic solid", "'newtonian fluid'"}},
    {"SemiImplicitWithSplines",
     {"Method/Time integration=semi-implicit",
      "Method/Kernel=quadratic",
      "Body beam/Material=newtonian fluid",
      "Body beam/Locking treatment=cell"},
     {"'semi-implicit'", "'quadratic'", "'Kernel = linear'"}},
    {"SemiImplicitWithMusl",
     {"Method/Time integration=semi-implicit",
      "Method/Stress update=musl",
      "Body beam/Material=newtonian fluid",
      "Body beam/Locking treatment=cell"},
     {"'semi-implicit'", "'musl'", "'Stress update = usl'"}},
    {"SemiImplicitWithoutMeanPressure",
     {"Method/Time integration=semi-implicit",
      "Body beam/Material=newtonian fluid",
      "Body beam/Locking treatment=node"},
     {"'semi-implicit'", "'node'", "'Locking treatment = cell'"}},
    {"DensityControlOfExplicitSteps",
     {"Body beam/Density control=0.2"},
     {"'Density control'", "'semi-implicit'", "'Density control = auto'"}},
    {"DensityControlBesideASolid",
     {"Method/Time integration=semi-implicit",
      "Body water/Locking treatment=cell",
      "Body water/Density control=0.2"},
     {"'Density control'", "liquids alone", "'Density control = auto'"}},
    {"AssumedStrainOfSplines",
     {"Method/Kernel=quadratic", "Body beam/Locking treatment=assumed strain"},
     {"'assumed strain'", "Kernel = quadratic", "Locking treatment = node"}},
    {"AssumedStrainOfCubicSplines",
     {"Method/Kernel=cubic", "Body beam/Locking treatment=assumed strain"},
     {"'assumed strain'", "Kernel = cubic", "Locking treatment = node"}},
    {"HourglassControlOfSplines",
     {"Method/Kernel=quadratic",
      "Body beam/Locking treatment=cell",
      "Body beam/Hourglass control=0.1"},
     {"'0.1'", "Kernel = quadratic", "Set 'Hourglass control = 0'"}},
    {"InitialFrameOfDomains",
     {"Method/Kernel=cpdi",
      "Body beam/Frame=initial",
      "Body beam/Locking treatment=none"},
     {"'initial'", "no points with domains", "Frame = current"}},
    {"InitialFrameOfDualDomains",
     {"Method/Kernel=ddmp",
      "Body beam/Frame=initial",
      "Body beam/Locking treatment=none"},
     {"'initial'", "no gradients that come from the nodes", "Frame = current"}},
    {"HourglassControlOfDualDomains",
     {"Method/Kernel=ddmp",
      "Body beam/Locking treatment=cell",
      "Body beam/Hourglass control=0.1"},
     {"'0.1'", "Kernel = ddmp", "Set 'Hourglass control = 0'"}},
    {"AssumedStrainOfDualDomains",
     {"Method/Kernel=ddmp", "Body beam/Locking treatment=assumed strain"},
     {"'assumed strain'", "several cells", "Locking treatment = cell"}},
    {"HistoryOfDualDomains",
     {"Method/Kernel=ddmp",
      "Body beam/Locking treatment=cell",
      "Body beam/History=replace"},
     {"'replace'", "Kernel = ddmp", "History = keep"}},
    {"InitialFrameOfSplinesWithAssumedStrain",
     {"Method/Kernel=quadratic",
      "Body beam/Frame=initial",
      "Body beam/Locking treatment=assumed strain"},
     {"'initial'", "linear functions only", "Set 'Method/Kernel = linear'"}},
    {"MeanShearOverCellsOfDomains",
     {"Method/Kernel=cpdi", "Body beam/Locking treatment=cell shear"},
     {"'cell shear'", "Kernel = cpdi", "Locking treatment = cell"}},
    {"HistoryOfDomains",
     {"Method/Kernel=gimp",
      "Body beam/Locking treatment=cell",
      "Body beam/History=replace"},
     {"'replace'", "Kernel = gimp", "History = keep"}},
    {"ApicOfDomains",
     {"Method/Kernel=cpdi",
      "Body beam/Locking treatment=node",
      "Method/Transfer=apic"},
     {"'apic'", "Kernel = cpdi", "Transfer = flip"}},
    {"ApicOfHexahedra",
     {"Method/Kernel=cpdi2",
      "Body beam/Locking treatment=node",
      "Method/Transfer=apic"},
     {"'apic'", "Kernel = cpdi2", "Transfer = flip"}},
    {"AflipOfDomains",
     {"Method/Kernel=gimp",
      "Body beam/Locking treatment=node",
      "Method/Transfer=aflip"},
     {"'aflip'", "Kernel = gimp", "Transfer = flip"}},
    {"KernelUnknown", {"Method/Kernel=gmip"}, {"Did you mean 'gimp'?"}},
    {"WordOfAFormerVersion",
     {"Method/Stress update=both ends"},
     {"'both ends'", "'usavg'", "Write 'Stress update = usavg'"}},
    {"OrderOfFlip",
     {"Method/Transfer order=2"},
     {"'2'", "'Transfer order'", "Transfer = fmpm"}},
    {"PeriodOfFlip",
     {"Method/Transfer period=5"},
     {"'5'", "'Transfer period'", "Transfer = fmpm"}},
    {"FullMassWithMusl",
     {"Method/Transfer=fmpm", "Method/Stress update=musl"},
     {"'musl'", "fmpm", "Set 'Stress update = usl'"}},
    {"RelaxWithoutTime",
     {"Body beam/History=relax"},
     {"relax", "'Relaxation time'", "0.01"}},
    {"TimeWithoutRelax",
     {"Body beam/Relaxation time=1"},
     {"'auto'", "History = relax"}},
    {"DeviatoricHistoryOfAFluid",
     {"Body water/Deviatoric history=replace",
      "Body water/Locking treatment=cell shear"},
     {"'replace'", "for solids", "Deviatoric history = keep"}},
    {"DeviatoricHistoryWithoutMeanShear",
     {"Body beam/Deviatoric history=replace",
      "Body beam/Locking treatment=cell"},
     {"'replace'", "'cell'", "Locking treatment = cell shear"}},
    {"HistoryWithoutTreatment",
     {"Body beam/History=replace", "Body beam/Locking treatment=none"},
     {"'replace'", "'none'"}},
    {"EntryOfAMaterialThatIsNotChosen",
     {"Body water/Young's modulus=1"},
     {"'Young's modulus'",
      "'Linear elastic'",
      "'Material' is 'newtonian fluid'"}},
    {"SectionOfABodyMisspelt",
     {"Body watr/History=keep"},
     {"'Body watr'", "Did you mean 'Body water'?"}},
    {"FormerNameOfTheBlendTime",
     {"Method/Damping time=0.1"},
     {"'Damping time'", "--set", "is called 'Blend time' now"}},
    {"FormerNameOfTheCheckerboardControl",
     {"Body water/Chequerboard control=0.5"},
     {"is called 'Checkerboard control' now"}},
    {"BlendWithApic",
     {"Method/Transfer=apic", "Method/Blend time=0.1"},
     {"0.1", "'apic'", "Blend time = 0"}},
    {"HydrostaticWithoutGravity",
     {"Body water/Initial pressure=hydrostatic"},
     {"gravity", "-9.81"}},
    {"HydrostaticSolid",
     {"Body beam/Initial pressure=hydrostatic"},
     {"solid", "'Initial stress", "'Body beam'"}},
    {"InitialStressOfALiquid",
     {"Body water/Initial stress=K0: 1"},
     {"solids", "Initial pressure", "'Body water'"}},
    {"InitialStressWithoutName",
     {"Body beam/Initial stress=0.5"},
     {"'0.5'", "':'", "K0: 0.5"}},
    {"InitialStressWithCommas",
     {"Body beam/Initial stress=K0: 0.5, overburden: 1e4"},
     {"'K0: 0.5, overburden: 1e4'", "second ':'", "';' between them"}},
    {"InitialStressOfAnUnknownComponent",
     {"Body beam/Initial stress=yz: 1"},
     {"'yz'", "'Initial stress'"}},
    {"InitialStressByBoth",
     {"Body beam/Initial stress=K0: 1; xx: 2", "Loads/Gravity=0, -9.81"},
     {"both", "K0", "'Body beam'"}},
    {"OverburdenWithoutRatio",
     {"Body beam/Initial stress=overburden: 1e4"},
     {"overburden", "K0: 0.5"}},
    {"GeostaticWithoutGravity",
     {"Body beam/Initial stress=K0: 0.5"},
     {"gravity", "-9.81"}},
    {"InitialStressInTheInitialFrame",
     {"Body beam/Initial stress=xx: 1", "Body beam/Frame=initial"},
     {"'initial'", "'Initial stress'"}},
    {"AutoWithoutVelocity",
     {"Body water/Newtonian fluid/Bulk modulus=auto"},
     {"auto", "2e9"}}};



  const std::vector<BadScene> bad_formulas = {
    {"InitialVelocityInTime",
     {"Body beam/Initial velocity=sin(t); 0"},
     {"'sin(t); 0'", "time t", "'Initial velocity'"}},
    {"FormulaComponents",
     {"Body beam/Initial velocity=1"},
     {"'1'", "1 component", "'0; 0'"}},
    {"FormulaUnknownName",
     {"Body beam/Initial velocity=0; vo"},
     {"vo", "'Initial velocity'", "'Body beam'"}},
    {"FormulaNotFinite",
     {"Body beam/Initial velocity=0; log(-1-x)"},
     {"not finite", "log(-1-x)"}},
    {"ConstantWithoutValue",
     {"Body beam/Constants=L"},
     {"'L'", "name = number"}},
    {"ConstantNamedAsVariable",
     {"Constants=t = 3"},
     {"'t'", "entry 'Constants'", "'t0'"}},
    {"FrictionWithoutCoefficient",
     {"Boundaries/left=friction"},
     {"'friction'", "Friction coefficient = 0.3"}},
    {"VelocityWithoutFormula",
     {"Boundaries/top=velocity"},
     {"'velocity'", "Side top", "Velocity = 0; 0"}},
    {"NormalVelocityAlongTheSide",
     {"Boundaries/top=normal velocity", "Boundaries/Side top/Velocity=1; 0"},
     {"'1; 0'", "along the side", "'Boundaries'", "to 'velocity'"}},
    {"PairOfABodyWithItself",
     {"Contact/Pair meeting/Bodies=beam, beam"},
     {"two different bodies", "Pair meeting", "Bodies = block, floor"}},
    {"PairOfUnknownBody",
     {"Contact/Pair meeting/Bodies=bean, water"},
     {"'bean'", "Did you mean 'beam'?"}},
    {"PairWithFrictionWithoutCoefficient",
     {"Contact/Pair meeting/Law=friction"},
     {"'friction'", "Pair meeting", "Friction coefficient = 0.3"}},
    {"PairWithAffineVelocity",
     {"Contact/Pair meeting/Law=slip", "Method/Transfer=apic"},
     {"'apic'", "entry 'Transfer'", "'Transfer = aflip' or 'flip'"}},
    {"FaceLoadOnUnknownBody",
     {"Loads/Face load press/Body=bean"},
     {"'bean'", "Did you mean 'beam'?"}},
    {"FaceOfABall",
     {"Body beam/Shape=ball"},
     {"'left'", "'beam'", "only boxes", "'Face = surface"}},
    {"FaceMisspelt",
     {"Loads/Face load press/Face=surfcae"},
     {"'surfcae'", "'Face'", "top | surface"}},
    {"FaceMissing", {"Loads/Face load press/Face="}, {"missing", "'Face'"}},
    {"WhereIsNotFinite",
     {"Loads/Face load press/Where=1/(0*x)"},
     {"'1/(0*x)'", "'Where'", "not finite"}},
    {"PressureAndTraction",
     {"Loads/Face load press/Traction=1; 0"},
     {"both", "exactly one"}},
    {"NeitherPressureNorTraction",
     {"Loads/Face load press/Pressure="},
     {"neither", "exactly one"}}};



  const std::vector<BadScene> bad_observables = {
    {"ObservableWithoutType",
     {"Observable tip/Type="},
     {"missing", "'Type'", "displacement"}},
    {"ObservableOfUnknownBody",
     {"Observable tip/Body=baem"},
     {"'baem'", "Did you mean 'beam'?"}},
    {"ObservableWithoutBody",
     {"Observable tip/Body="},
     {"several", "beam, water"}},
    {"LocationOutsideGrid",
     {"Observable tip/Location=1, 9"},
     {"(1, 9)", "outside the grid"}},
    {"LocationMissing", {"Observable tip/Location="}, {"'Location'"}},
    {"RegionOutsideGrid",
     {"Observable tip/Type=mean pressure",
      "Observable tip/Location=",
      "Observable tip/Direction=",
      "Observable tip/Within=0, 8; 1, 9"},
     {"(0, 8)", "outside the grid"}},
    {"MeanOfAMean",
     {"Observable tip/Type=mean over time",
      "Observable tip/Location=",
      "Observable tip/Body=",
      "Observable tip/Direction=",
      "Observable tip/Observable=tip"},
     {"'mean over time'", "itself taken of another one"}},
    {"DirectionOfAStress",
     {"Observable tip/Type=stress"},
     {"'y'", "two letters", "'xx'"}},
    {"WithinWhereItHasNoMeaning",
     {"Observable tip/Within=0, 0; 1, 1"},
     {"no meaning", "displacement"}},
    {"WithinUpsideDown",
     {"Observable tip/Type=extreme coordinate",
      "Observable tip/Location=",
      "Observable tip/Within=1, 1; 0, 0"},
     {"(0, 0)", "(1, 1)", "'Within'"}},
    {"VariableOfAnElasticBody",
     {"Observable tip/Type=state variable",
      "Observable tip/Direction=",
      "Observable tip/Variable=equivalent plastic strain"},
     {"'equivalent plastic strain'", "'linear elastic'", "'beam'"}},
    {"VariableUnknown",
     {"Observable tip/Type=state variable",
      "Observable tip/Direction=",
      "Observable tip/Variable=plastic"},
     {"'plastic'", "'Variable'"}},
    {"LargestVariableOfWhichBody",
     {"Observable tip/Type=largest state variable",
      "Observable tip/Direction=",
      "Observable tip/Location=",
      "Observable tip/Body=",
      "Observable tip/Variable=opening"},
     {"No body", "several", "'set Body = beam'"}},
    {"YieldStressMissing",
     {"Body beam/Material=j2"},
     {"missing", "'Yield stress'"}},
    {"SofteningYieldStress",
     {"Body beam/Material=j2",
      "Body beam/J2/Yield stress=1e5",
      "Body beam/J2/Hardening modulus=-1"},
     {"'-1'", "Hardening modulus"}},
    {"NegativeSaturation",
     {"Body beam/Material=j2",
      "Body beam/J2/Yield stress=1e5",
      "Body beam/J2/Saturation hardening=-5"},
     {"'-5'", "Saturation hardening"}},
    {"FrictionAngleMissing",
     {"Body beam/Material=drucker prager"},
     {"missing", "'Friction angle'"}},
    {"NegativeCohesion",
     {"Body beam/Material=drucker prager",
      "Body beam/Drucker prager/Friction angle=30",
      "Body beam/Drucker prager/Cohesion=-1"},
     {"'-1'", "Cohesion"}},
    {"DilatancyBeyondFriction",
     {"Body beam/Material=drucker prager",
      "Body beam/Drucker prager/Friction angle=20",
      "Body beam/Drucker prager/Dilatancy angle=30"},
     {"'Dilatancy angle'", "larger", "'Drucker prager'"}},
    {"FlowExponentBeyondOne",
     {"Body beam/Material=j2",
      "Body beam/J2/Yield stress=1e5",
      "Body beam/J2/Flow exponent=1.5"},
     {"'1.5'", "Flow exponent"}},
    {"LimitAngleBelowThatOfRest",
     {"Body beam/Material=drucker prager",
      "Body beam/Drucker prager/Friction angle=30",
      "Body beam/Drucker prager/Limit friction angle=20"},
     {"'Limit friction angle'", "smaller", "'Drucker prager'"}},
    {"CohesionWithInertialFriction",
     {"Body beam/Material=drucker prager",
      "Body beam/Drucker prager/Friction angle=20",
      "Body beam/Drucker prager/Limit friction angle=30",
      "Body beam/Drucker prager/Cohesion=100"},
     {"'Limit friction angle'", "'Cohesion'"}},
    {"GrainsWithoutSize",
     {"Body beam/Material=drucker prager",
      "Body beam/Drucker prager/Friction angle=20",
      "Body beam/Drucker prager/Grain diameter=0"},
     {"'0'", "Grain diameter"}},
    {"NothingBearsShear",
     {"Body beam/Material=drucker prager",
      "Body beam/Drucker prager/Friction angle=0"},
     {"'Cohesion'", "zero", "newtonian fluid"}},
    {"CompressionIndexMissing",
     {"Body beam/Material=cam clay", "Body beam/Cam clay/Shear modulus=1e6"},
     {"missing", "'Compression index'"}},
    {"SwellingBeyondCompression",
     {"Body beam/Material=cam clay",
      "Body beam/Cam clay/Shear modulus=1e6",
      "Body beam/Cam clay/Compression index=0.02",
      "Body beam/Cam clay/Swelling index=0.1",
      "Body beam/Cam clay/Critical state slope=1"},
     {"'Compression index'", "'Swelling index'", "swapped", "'Cam clay'"}},
    {"CriticalStateWithoutStrength",
     {"Body beam/Material=cam clay",
      "Body beam/Cam clay/Shear modulus=1e6",
      "Body beam/Cam clay/Compression index=0.1",
      "Body beam/Cam clay/Swelling index=0.02",
      "Body beam/Cam clay/Critical state slope=0"},
     {"'0'", "Critical state slope"}},
    {"NegativePreconsolidation",
     {"Body beam/Material=cam clay",
      "Body beam/Cam clay/Shear modulus=1e6",
      "Body beam/Cam clay/Compression index=0.1",
      "Body beam/Cam clay/Swelling index=0.02",
      "Body beam/Cam clay/Critical state slope=1",
      "Body beam/Cam clay/Preconsolidation pressure=-1"},
     {"'-1'", "Preconsolidation pressure"}},
    {"InitialStateOfAnElasticBody",
     {"Body beam/Initial state=equivalent plastic strain: 0.1"},
     {"'equivalent plastic strain'", "no memory", "'Initial state'"}},
    {"InitialStateOfAnUnknownVariable",
     {"Body beam/Material=j2",
      "Body beam/J2/Yield stress=1e5",
      "Body beam/Initial state=plastic strain: 0.1"},
     {"'plastic strain'", "'Initial state'"}},
    {"InitialStateWithoutName",
     {"Body beam/Material=j2",
      "Body beam/J2/Yield stress=1e5",
      "Body beam/Initial state=0.1*x"},
     {"'0.1*x'", "':'"}},
    {"FrequencyOfUnknown",
     {"Observable hertz/Observable=tpi"},
     {"'tpi'", "Did you mean 'tip'?"}},
    {"FrequencyOfItself",
     {"Observable hertz/Observable=hertz"},
     {"'hertz'", "frequency"}},
    {"CheckOfUnknown",
     {"Check swing/Observable=herz"},
     {"'herz'", "Did you mean 'hertz'?"}},
    {"CheckAfterTheEnd",
     {"Check swing/At time=2"},
     {"2", "'At time'", "End time"}},
    {"CheckWithoutReference", {"Check swing/Reference="}, {"'Reference'"}},
    {"FieldsBesideNone",
     {"Output/Fields=none, velocity"},
     {"'none'", "'Fields'"}},
    {"PointArraysWithoutTimes",
     {"Output/Point arrays=true"},
     {"'Point arrays'", "Time interval"}},
    {"ReferenceOfUnknownElement",
     {"Reference/Element=Q2-P1-P0"},
     {"Q2-P1-P0", "Q2-P1-P1"}},
    {"ReferenceWithMeshAndElements",
     {"Reference/Mesh file=a.msh", "Reference/Elements=8, 8"},
     {"mesh file", "'Elements'", "'Refinements'"}},
    {"ExactSolutionOfOneComponent",
     {"Exact solution/Displacement=x"},
     {"'Displacement'", "2"}}};



  const std::string fine_corner = R"(
    subsection Grid
      set Levels = 2
      set Refine = corner
      subsection Refine corner
        set Upper corner = 1, 1
      end
    end
    )";

  const std::vector<BadScene> bad_levels = {
    {"RefinementWithoutLevels",
     {"Grid/Levels=0"},
     {"'corner'", "'Levels", "one level only"},
     fine_corner},
    {"LevelsWithoutRefinement",
     {"Grid/Levels=1"},
     {"'Refine", "nothing says where"}},
    {"TooManyLevels", {"Grid/Levels=5"}, {"'Levels'", "0 to 4"}, fine_corner},
    {"LevelsBeyondTheForest",
     {"Grid/Cells=268435456, 268435456"},
     {"'Levels = 2'", "28", "29", "p4est"},
     fine_corner},
    {"LevelBeyondTheFinest",
     {"Grid/Refine corner/Level=3"},
     {"'Level", "3", "'Grid/Levels = 2'"},
     fine_corner},
    {"RefinementWithoutBounds",
     {"Grid/Refine corner/Upper corner="},
     {"'corner'", "no bounds"},
     fine_corner},
    {"RefinementUpsideDown",
     {"Grid/Refine corner/Lower corner=2, 0"},
     {"'Upper corner'", "swapped"},
     fine_corner},
    {"RefinementThatIsNotFinite",
     {"Grid/Refine corner/Where=1/(x-x)"},
     {"not finite", "'Where'"},
     fine_corner},
    {"SplinesOnLevels",
     {"Method/Kernel=quadratic"},
     {"'quadratic'", "'Kernel'", "several sizes", "'Kernel = linear'"},
     fine_corner},
    {"HexahedraOnLevels",
     {"Method/Kernel=cpdi2"},
     {"'cpdi2'", "several sizes", "cannot be split", "'Kernel = linear'"},
     fine_corner},
    {"BoxesThatAreJoined",
     {"Method/Kernel=gimp", "Grid/Join points=true"},
     {"'gimp'", "joined points", "'Join points = false'"},
     fine_corner},
    {"FittedPointsOnLevels",
     {"Body beam/Placement=fitted"},
     {"'fitted'", "'Placement'", "'Placement = cut'"},
     fine_corner},
    {"CriterionWithoutScale",
     {"Grid/Refine corner/Criterion=rate"},
     {"'rate'", "'Criterion", "no scale", "'Scale'"},
     fine_corner},
    {"StressWithoutScale",
     {"Grid/Refine corner/Criterion=stress"},
     {"'stress'", "no scale", "'Scale' to a stress in Pa"},
     fine_corner},
    {"ScaleOfNothing",
     {"Grid/Refine corner/Criterion=stress", "Grid/Refine corner/Scale=0"},
     {"'Scale'", "greater than 0"},
     fine_corner},
    {"NegativeScale",
     {"Grid/Refine corner/Criterion=rate", "Grid/Refine corner/Scale=-0.1"},
     {"'Scale'", "greater than 0"},
     fine_corner},
    {"ScaleOfARegion",
     {"Grid/Refine corner/Scale=0.1"},
     {"'region'", "no use for a scale", "'Scale' empty"},
     fine_corner},
    {"PlasticStrainOfNobody",
     {"Grid/Refine corner/Criterion=plastic strain",
      "Grid/Refine corner/Scale=0.1"},
     {"'plastic strain'", "no body's material", "'j2'"},
     fine_corner},
    {"PlasticStrainOfAnElasticBody",
     {"Grid/Refine corner/Criterion=plastic strain",
      "Grid/Refine corner/Scale=0.1",
      "Grid/Refine corner/Bodies=beam"},
     {"'plastic strain'", "'beam'", "has none", "'Material'"},
     fine_corner},
    {"RateOfAnUnknownBody",
     {"Grid/Refine corner/Criterion=rate",
      "Grid/Refine corner/Scale=0.1",
      "Grid/Refine corner/Bodies=baem"},
     {"'baem'", "'beam'"},
     fine_corner},
    {"ObstaclesOfNobody",
     {"Grid/Refine corner/Criterion=obstacle"},
     {"'obstacle'", "'Criterion", "nothing to look at", "'Obstacles'"},
     fine_corner},
    {"ObstaclesOfARegion",
     {"Grid/Refine corner/Obstacles=step"},
     {"'region'", "'Obstacles", "no effect", "'Criterion = obstacle'"},
     fine_corner},
    {"ContactOfNobody",
     {"Grid/Refine corner/Criterion=contact"},
     {"'contact'", "'Criterion", "no bodies may part", "'Contact/Pairs'"},
     fine_corner},
    {"JoiningWithoutLevels",
     {"Grid/Join points=true"},
     {"'Join points", "one level only", "'Levels = 1'"}},
    {"StretchedPointsOfALiquid",
     {"Body water/Split stretched points=true"},
     {"'water'", "keeps no shape", "'Split stretched points = false'"}},
    {"StretchedPointsWithFixedBoxes",
     {"Body beam/Split stretched points=true",
      "Body beam/Frame=current",
      "Method/Kernel=gimp"},
     {"'beam'", "do not become halves", "cpgimp"}},
    {"StretchedPointsThatFlow",
     {"Body beam/Split stretched points=true",
      "Body beam/Material=j2",
      "Body beam/J2/Yield stress=1",
      "Method/Kernel=linear"},
     {"'beam'", "flowed plastically", "'Method/Kernel = cpgimp'"}},
    {"StretchedPointsWithNewtonSteps",
     {"Body beam/Split stretched points=true",
      "Body beam/Frame=current",
      "Body water/Material=neo hookean",
      "Method/Time integration=implicit",
      "Method/Time step=0.1"},
     {"'beam'", "Newton steps", "explicit"}},
    {"HistoryOfCrossingsOnLevels",
     {"Body water/History=crossing"},
     {"'crossing'", "'History = relax'"},
     fine_corner}};



  std::string
  name_of_scene(const testing::TestParamInfo<BadScene> &info)
  {
    return info.param.name;
  }
} // namespace

INSTANTIATE_TEST_SUITE_P(Forms,
                         BadScenes,
                         testing::ValuesIn(bad_forms),
                         name_of_scene);
INSTANTIATE_TEST_SUITE_P(Frames,
                         BadScenes,
                         testing::ValuesIn(bad_frames),
                         name_of_scene);
INSTANTIATE_TEST_SUITE_P(Levels,
                         BadScenes,
                         testing::ValuesIn(bad_levels),
                         name_of_scene);
INSTANTIATE_TEST_SUITE_P(Bodies,
                         BadScenes,
                         testing::ValuesIn(bad_bodies),
                         name_of_scene);
INSTANTIATE_TEST_SUITE_P(Formulas,
                         BadScenes,
                         testing::ValuesIn(bad_formulas),
                         name_of_scene);
INSTANTIATE_TEST_SUITE_P(Observables,
                         BadScenes,
                         testing::ValuesIn(bad_observables),
                         name_of_scene);
