// SPDX-License-Identifier: LGPL-2.1-or-later
#include <limber/problem/mesh_builder.h>

#include <algorithm>
#include <array>

namespace limber
{
  namespace
  {
    constexpr ElementKind element_kinds[] = {
      {15, 1, "pt", "point", 0, 1},
      {1, 3, "line", "line", 1, 2},
      {8, 21, "", "line of three nodes", 1, 3},
      {2, 5, "tri", "triangle", 2, 3},
      {9, 22, "", "triangle of six nodes", 2, 6},
      {3, 9, "quad", "quadrilateral", 2, 4},
      {16, 23, "", "quadrilateral of eight nodes", 2, 8},
      {10, 28, "", "quadrilateral of nine nodes", 2, 9},
      {4, 10, "tet", "tetrahedron", 3, 4},
      {11, 24, "", "tetrahedron of ten nodes", 3, 10},
      {5, 12, "hex", "hexahedron", 3, 8},
      {17, 25, "", "hexahedron of 20 nodes", 3, 20},
      {12, 29, "", "hexahedron of 27 nodes", 3, 27},
      {6, 13, "prism", "prism", 3, 6},
      {7, 14, "pyr", "pyramid", 3, 5}};



    template <typename Test>
    const ElementKind &
    find_kind(const MeshWords   &words,
              const std::string &found,
              const Test        &is_meant)
    {
      const auto kind = std::find_if(std::begin(element_kinds),
                                     std::end(element_kinds),
                                     is_meant);
      if (kind == std::end(element_kinds))
        words.refuse("The kind of element " + in_quotes(found) +
                       " is not known",
                     "Usually it is of higher order, a polygon, a pixel or a "
                     "voxel. Save quadrilaterals or hexahedra of order 1.");
      return *kind;
    }



    std::array<double, 3>
    read_place(MeshWords &words, const long node)
    {
      std::array<double, 3> place;
      for (double &x : place)
        x = words.coordinate(node);
      return place;
    }



    const ElementKind &
    read_kind_of_gmsh(MeshWords &words)
    {
      const long number = words.integer("the kind of an element");
      return find_kind(words, std::to_string(number), [&](const auto &kind) {
        return kind.number_of_gmsh == number;
      });
    }



    template <int dim>
    void
    read_nodes_of_gmsh(MeshWords        &words,
                       const bool        blocks,
                       MeshBuilder<dim> &mesh)
    {
      const long n_blocks = blocks ? words.count("blocks of nodes", 2) : 1;
      const long n_nodes  = words.count("nodes", 2);
      if (!blocks)
        {
          for (long i = 0; i < n_nodes; ++i)
            {
              const long number = words.integer("the number of a node");
              mesh.add_node(number, read_place(words, number));
            }
          return;
        }
      words.integer("the smallest number of a node");
      words.integer("the largest number of a node");
      for (long b = 0; b < n_blocks; ++b)
        {
          words.integer("the dimension of a block");
          words.integer("the number of a block");
          if (words.integer("the parametric flag") != 0)
            words.refuse("Nodes have parametric coordinates",
                         "Save the mesh without them.");
          std::vector<long> numbers(words.count("nodes of a block", 2));
          for (long &number : numbers)
            number = words.integer("the number of a node");
          for (const long number : numbers)
            mesh.add_node(number, read_place(words, number));
        }
    }



    template <int dim>
    void
    read_elements_of_gmsh(MeshWords        &words,
                          const bool        blocks,
                          MeshBuilder<dim> &mesh)
    {
      const long n_blocks   = blocks ? words.count("blocks of elements", 2) : 1;
      const long n_elements = words.count("elements", 2);
      if (!blocks)
        {
          for (long i = 0; i < n_elements; ++i)
            {
              const long number = words.integer("the number of an element");
              const ElementKind &kind   = read_kind_of_gmsh(words);
              const long         n_tags = words.count("tags", 2);
              for (long tag = 0; tag < n_tags; ++tag)
                words.integer("a tag");
              mesh.read_element(number, kind);
            }
          return;
        }
      words.integer("the smallest number of an element");
      words.integer("the largest number of an element");
      for (long b = 0; b < n_blocks; ++b)
        {
          words.integer("the dimension of a block");
          words.integer("the number of a block");
          const ElementKind &kind = read_kind_of_gmsh(words);
          const long         n    = words.count("elements of a block", 2);
          for (long i = 0; i < n; ++i)
            {
              const long number = words.integer("the number of an element");
              mesh.read_element(number, kind);
            }
        }
    }



    template <int dim>
    void
    read_gmsh(MeshWords &words, MeshBuilder<dim> &mesh)
    {
      words.expect("$MeshFormat");
      const std::string version = words.word("the version");
      const bool        blocks  = version == "4.1";
      if (!blocks && version.rfind("2", 0) != 0)
        words.refuse("The format has the version " + in_quotes(version),
                     "Versions 2 and 4.1 are read. In Gmsh, set "
                     "'Mesh.MshFileVersion = 2.2' and save it again.");
      if (words.integer("the kind of file") != 0)
        words.refuse("The file is binary",
                     "In Gmsh, set 'Mesh.Binary = 0' and save it again.");
      words.skip_to("$EndMeshFormat");
      while (!words.at_end())
        {
          const std::string section = words.word("a section");
          if (section == "$Nodes")
            read_nodes_of_gmsh(words, blocks, mesh);
          else if (section == "$Elements")
            read_elements_of_gmsh(words, blocks, mesh);
          else if (section.empty() || section.front() != '$')
            words.refuse("Instead of a section there is " + in_quotes(section),
                         "Usually a count before is too small. Make the mesh "
                         "anew.");
          const std::string end = "$End" + section.substr(1);
          if (section == "$Nodes" || section == "$Elements")
            words.expect(end);
          else
            words.skip_to(end);
        }
    }



    template <int dim>
    void
    read_ucd(MeshWords &words, MeshBuilder<dim> &mesh)
    {
      const long n_nodes    = words.count("nodes", 2);
      const long n_elements = words.count("elements", 2);
      for (const char *const data : {"nodes", "elements", "the model"})
        words.integer(std::string("the number of data of ") + data);
      for (long i = 0; i < n_nodes; ++i)
        {
          const long number = words.integer("the number of a node");
          mesh.add_node(number, read_place(words, number));
        }
      for (long i = 0; i < n_elements; ++i)
        {
          const long number = words.integer("the number of an element");
          words.integer("a material");
          const std::string kind = words.word("the kind of an element");
          mesh.read_element(number,
                            find_kind(words, kind, [&](const auto &known) {
                              return known.word_of_ucd == kind;
                            }));
        }
    }



    /**
     * Elements side by side with their types (CELL_TYPES), which the file lists
     * behind all elements.
     */
    template <int dim>
    void
    read_elements_of_vtk(MeshWords        &words,
                         const MeshWords  &start_of_kinds,
                         const long        n_elements,
                         MeshBuilder<dim> &mesh)
    {
      MeshWords kinds = start_of_kinds;
      for (long i = 0; i < n_elements; ++i)
        {
          const long         number = kinds.integer("the kind of an element");
          const ElementKind &kind =
            find_kind(kinds, std::to_string(number), [&](const auto &known) {
              return known.number_of_vtk == number;
            });
          if (words.integer("the number of nodes of an element") !=
              long(kind.n_nodes))
            words.refuse("Element " + std::to_string(i) +
                           " has another number of nodes than a " + kind.name,
                         "Usually a line is missing. Make the mesh anew.");
          mesh.read_element(i, kind);
        }
    }



    template <int dim>
    void
    read_vtk(MeshWords &words, MeshBuilder<dim> &mesh)
    {
      words.skip_to("ASCII");
      words.skip_to("UNSTRUCTURED_GRID");
      words.skip_to("POINTS");
      const long n_nodes = words.count("nodes", 2);
      words.word("the type of coordinates");
      for (long i = 0; i < n_nodes; ++i)
        mesh.add_node(i, read_place(words, i));
      words.skip_to("CELLS");
      const long n_elements = words.count("elements", 2);
      words.count("numbers of elements", 2);
      MeshWords kinds = words;
      kinds.skip_to("CELL_TYPES");
      if (kinds.count("kinds of elements", 2) != n_elements)
        kinds.refuse("There are not as many kinds as elements",
                     "Usually the file was edited. Make the mesh anew.");
      read_elements_of_vtk(words, kinds, n_elements, mesh);
    }



    /** UCD files begin with comment lines. */
    void
    skip_remarks(const std::string &text, MeshWords &words)
    {
      std::size_t begin = 0;
      while (begin < text.size() && text[begin] == '#')
        {
          words.skip_line();
          begin = std::min(text.find('\n', begin), text.size() - 1) + 1;
        }
    }
  } // namespace



  template <int dim>
  const std::vector<std::vector<unsigned int>> &
  faces_of_element(const std::size_t n_nodes)
  {
    using Faces = std::vector<std::vector<unsigned int>>;
    static const Faces simplex =
      dim == 2 ? Faces{{0, 1}, {1, 2}, {2, 0}} :
                 Faces{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    static const Faces hypercube = dim == 2 ?
                                     Faces{{0, 1}, {1, 3}, {3, 2}, {2, 0}} :
                                     Faces{{0, 4, 6, 2},
                                           {1, 3, 7, 5},
                                           {0, 1, 5, 4},
                                           {2, 6, 7, 3},
                                           {0, 2, 3, 1},
                                           {4, 5, 7, 6}};
    return n_nodes == dim + 1 ? simplex : hypercube;
  }



  template <int dim>
  CoarseMesh<dim>
  read_mesh_text(const std::string &text, const MeshRequest &request)
  {
    const std::string &path = request.path;
    const std::string  ending =
      path.substr(std::min(path.rfind('.'), path.size()));
    MeshWords        words(text, request);
    MeshBuilder<dim> mesh(words, request.simplices);
    if (ending == ".msh")
      read_gmsh(words, mesh);
    else if (ending == ".vtk")
      read_vtk(words, mesh);
    else if (ending == ".inp")
      {
        if (!text.empty() && text.front() == '*')
          words.refuse("The file begins with '*', as those of Abaqus do",
                       "Of files 'inp' those of UCD (AVS) are read. Save it as "
                       "vtk or msh.");
        skip_remarks(text, words);
        read_ucd(words, mesh);
      }
    else
      throw InputError(
        "The mesh " + in_quotes(path) + " in entry " + request.entry +
        " has an ending that names no known format. Known are msh (Gmsh), inp (UCD) "
        "and vtk. Save it as 'panel.msh', for instance.");
    return mesh.finish();
  }



  template const std::vector<std::vector<unsigned int>> &
    faces_of_element<2>(std::size_t);
  template const std::vector<std::vector<unsigned int>> &
    faces_of_element<3>(std::size_t);
  template CoarseMesh<2>
  read_mesh_text(const std::string &, const MeshRequest &);
  template CoarseMesh<3>
  read_mesh_text(const std::string &, const MeshRequest &);
} // namespace limber
