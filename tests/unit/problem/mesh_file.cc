// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/base/exceptions.h>
#include <limber/problem/mesh_file.h>

#include <gtest/gtest.h>

#include <sstream>

using namespace limber;

namespace
{
  // Two squares side by side, the second one numbered the other way around.
  const std::string gmsh_2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                             "$PhysicalNames\n1\n2 1 \"body\"\n"
                             "$EndPhysicalNames\n"
                             "$Nodes\n7\n"
                             "1 0 0 0\n2 1 0 0\n3 2 0 0\n"
                             "4 0 1 0\n5 1 1 0\n6 2 1 0\n9 5 5 0\n"
                             "$EndNodes\n"
                             "$Elements\n4\n"
                             "1 15 2 0 1 1\n2 1 2 0 1 1 2\n"
                             "3 3 2 1 1 1 2 5 4\n4 3 2 1 1 2 5 6 3\n"
                             "$EndElements\n";
  const std::string gmsh_4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
                             "$Entities\n0 0 1 0\n1 0 0 0 2 1 0 0 0\n"
                             "$EndEntities\n"
                             "$Nodes\n2 6 1 6\n"
                             "2 1 0 4\n1\n2\n4\n5\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n"
                             "2 2 0 2\n3\n6\n2 0 0\n2 1 0\n"
                             "$EndNodes\n"
                             "$Elements\n1 2 1 2\n2 1 3 2\n"
                             "1 1 2 5 4\n2 2 3 6 5\n$EndElements\n";
  const std::string ucd    = "# remark\n# another\n6 3 0 0 0\n"
                             "1 0 0 0\n2 1 0 0\n3 2 0 0\n"
                             "4 0 1 0\n5 1 1 0\n6 2 1 0\n"
                             "1 0 quad 1 2 5 4\n2 0 quad 2 3 6 5\n3 1 line 1 2\n";
  const std::string vtk    = "# vtk DataFile Version 3.0\ntwo squares\nASCII\n"
                             "DATASET UNSTRUCTURED_GRID\nPOINTS 6 double\n"
                             "0 0 0\n1 0 0\n2 0 0\n0 1 0\n1 1 0\n2 1 0\n"
                             "CELLS 2 10\n4 0 1 4 3\n4 1 2 5 4\n"
                             "CELL_TYPES 2\n9\n9\n";
  const std::string cube   = "8 1 0 0 0\n"
                             "1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n"
                             "5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n"
                             "1 0 hex 1 2 3 4 5 6 7 8\n";



  std::string
  replaced(std::string text, const std::string &from, const std::string &to)
  {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
  }



  template <int dim>
  double
  corner_volume(const CoarseMesh<dim> &mesh, const unsigned int cell)
  {
    dealii::Tensor<2, dim> edges;
    const auto            &v = mesh.cells[cell].vertices;
    for (unsigned int d = 0; d < dim; ++d)
      edges[d] = mesh.vertices[v[1u << d]] - mesh.vertices[v[0]];
    return determinant(edges);
  }
} // namespace



struct BadMesh
{
  std::string              name, text;
  std::vector<std::string> expected;
  std::string              ending = ".msh";
};



static std::ostream &
operator<<(std::ostream &out, const BadMesh &mesh)
{
  return out << mesh.name;
}



class BadMeshes : public testing::TestWithParam<BadMesh>
{};



TEST(MeshFiles, OfAllFormatsAreTheSame)
{
  for (const auto &[text, path] :
       {std::pair<std::string, std::string>{gmsh_2, "a.msh"},
        {gmsh_4, "a.msh"},
        {ucd, "a.inp"},
        {vtk, "a.vtk"}})
    {
      const CoarseMesh<2> mesh = read_mesh_text<2>(text, {path, "test"});
      EXPECT_EQ(mesh.vertices.size(), 6u) << path;
      ASSERT_EQ(mesh.cells.size(), 2u) << path;
      for (const unsigned int cell : {0, 1})
        EXPECT_DOUBLE_EQ(corner_volume(mesh, cell), 1) << path;
    }
}



TEST(MeshFiles, CubesMayGoAroundEitherWay)
{
  for (const std::string nodes : {"1 2 3 4 5 6 7 8", "5 6 7 8 1 2 3 4"})
    {
      const CoarseMesh<3> mesh =
        read_mesh_text<3>(replaced(cube, "1 2 3 4 5 6 7 8", nodes),
                          {"a.inp", "test"});
      ASSERT_EQ(mesh.cells.size(), 1u);
      EXPECT_DOUBLE_EQ(corner_volume(mesh, 0), 1);
    }
}



TEST_P(BadMeshes, AreRefusedWithTheLine)
{
  const BadMesh &bad = GetParam();
  try
    {
      read_mesh_text<2>(bad.text,
                        {"panel" + bad.ending, "'Reference/Mesh file'"});
      FAIL() << "The mesh was accepted.";
    }
  catch (const InputError &error)
    {
      const std::string message = error.what();
      for (const std::string &fragment : bad.expected)
        EXPECT_NE(message.find(fragment), std::string::npos)
          << "expected: " << fragment << "\nin: " << message;
      std::istringstream words(message);
      unsigned int       n = 0;
      for (std::string word; words >> word;)
        ++n;
      EXPECT_GE(n, 15u) << message;
      EXPECT_LE(n, 45u) << message;
    }
}



namespace
{
  const std::vector<BadMesh> bad_meshes = {
    {"Triangle",
     replaced(gmsh_2, "3 3 2 1 1 1 2 5 4", "3 2 2 1 1 1 2 5"),
     {"Element 3 is a triangle", "line 22", "recombine"}},
    {"TriangleOfUcd",
     replaced(ucd, "1 0 quad 1 2 5 4", "1 0 tri 1 2 5"),
     {"Element 1 is a triangle", "line 10"},
     ".inp"},
    {"HexahedronInThePlane",
     replaced(gmsh_2, "3 3 2 1 1 1 2 5 4", "3 5 2 1 1 1 2 5 4 1 2 5 4"),
     {"hexahedron"}},
    {"NegativeCount",
     replaced(gmsh_2, "$Nodes\n7", "$Nodes\n-5"),
     {"number of nodes is -5", "line 9"}},
    {"HugeCount",
     replaced(gmsh_2, "$Nodes\n7", "$Nodes\n999999999"),
     {"999999999", "does not hold"}},
    {"HugeCountOfUcd",
     replaced(ucd, "6 3 0 0 0", "6 99999999999 0 0 0"),
     {"99999999999", "elements"},
     ".inp"},
    {"OfAbaqus", "*HEADING\n*NODE\n", {"Abaqus", "UCD"}, ".inp"},
    {"NoCount",
     replaced(vtk, "CELLS 2", "CELLS two"),
     {"'two'", "line 12"},
     ".vtk"},
    {"CountTooSmall",
     replaced(gmsh_2, "$Nodes\n7", "$Nodes\n6"),
     {"'$EndNodes'", "'9'"}},
    {"Twisted",
     replaced(gmsh_2, "1 2 5 4\n", "1 2 4 5\n"),
     {"Element 3 is twisted", "line 22"}},
    {"Flat", replaced(gmsh_2, "5 1 1 0", "5 0.5 0.5 0"), {"Element 3 is flat"}},
    {"NodeTwiceInAnElement",
     replaced(gmsh_2, "1 2 5 4\n", "1 2 2 4\n"),
     {"Element 3 has one node twice"}},
    {"NodeGivenTwice",
     replaced(gmsh_2, "5 1 1 0", "4 1 1 0"),
     {"Node 4 is given twice", "line 14"}},
    {"NodeNotGiven",
     replaced(gmsh_2, "1 2 5 4\n", "1 2 5 8\n"),
     {"node 8", "not given"}},
    {"ElementTwice",
     replaced(gmsh_2, "2 5 6 3", "4 5 2 1"),
     {"Element 4", "element 3"}},
    {"NotFinite",
     replaced(gmsh_2, "5 1 1 0", "5 nan 1 0"),
     {"'nan'", "Node 5"}},
    {"OutOfThePlane",
     replaced(gmsh_2, "5 1 1 0", "5 1 1 0.5"),
     {"z = 0.5", "Dimension = 3"}},
    {"CutOff", gmsh_2.substr(0, gmsh_2.find("4 0 1 0")), {"The file ends"}},
    {"CutOffInElements",
     gmsh_2.substr(0, gmsh_2.find(" 5 6 3")),
     {"The file ends"}},
    {"NoElements",
     gmsh_2.substr(0, gmsh_2.find("$Elements")),
     {"No quadrilateral"}},
    {"NoSections", "hello world", {"'$MeshFormat'", "'hello'"}},
    {"OtherVersion",
     replaced(gmsh_2, "2.2 0 8", "4 0 8"),
     {"version '4'", "2.2"}},
    {"Binary", replaced(gmsh_2, "2.2 0 8", "2.2 1 8"), {"binary"}},
    {"UnknownKind",
     replaced(gmsh_2, "3 3 2 1 1", "3 77 2 1 1"),
     {"'77'", "not known"}},
    {"KindsMissing",
     replaced(vtk, "CELL_TYPES 2\n9\n9\n", "CELL_TYPES 1\n9\n"),
     {"as many kinds"},
     ".vtk"},
    {"OtherNumberOfNodes",
     replaced(vtk, "4 0 1 4 3", "3 0 1 4"),
     {"Element 0", "quadrilateral"},
     ".vtk"},
    {"OtherFormat", gmsh_2, {"ending", "msh (Gmsh)"}, ".exo"}};
} // namespace

INSTANTIATE_TEST_SUITE_P(All,
                         BadMeshes,
                         testing::ValuesIn(bad_meshes),
                         [](const testing::TestParamInfo<BadMesh> &info) {
                           return info.param.name;
                         });
