// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef limber_problem_mesh_builder_h
#define limber_problem_mesh_builder_h

#include <deal.II/base/tensor.h>

#include <limber/base/exceptions.h>
#include <limber/base/text.h>
#include <limber/problem/mesh_file.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

/**
 * @file Common tools of the readers of mesh files: the words of a file, and a
 * mesh that checks each node and element before it takes it.
 */
namespace limber
{
  /** A kind of element as the formats name it. */
  struct ElementKind
  {
    int          number_of_gmsh, number_of_vtk;
    const char  *word_of_ucd, *name;
    unsigned int dimension, n_nodes;
  };



  /** The words of a file, one after the other, with the line they are in. */
  class MeshWords
  {
  public:
    MeshWords(const std::string &text, const MeshRequest &request)
      : text(text)
      , request(request)
    {
      skip_blanks();
    }

    [[noreturn]] void
    refuse(const std::string &what, const std::string &remedy) const
    {
      throw InputError(what + " in line " + std::to_string(line) +
                       " of the mesh " + in_quotes(request.path) + " (" +
                       request.entry + "). " + remedy);
    }

    bool
    at_end() const
    {
      return next == text.size();
    }

    std::string
    word(const std::string &what)
    {
      if (at_end())
        refuse("The file ends before " + what,
               "Usually it was cut off while it was copied. Write it anew.");
      const std::size_t end =
        std::min(text.find_first_of(" \t\r\n", next), text.size());
      const std::string result = text.substr(next, end - next);
      line                     = line_of_next;
      next                     = end;
      skip_blanks();
      return result;
    }

    double
    coordinate(const long node)
    {
      const std::string found = word("a coordinate");
      const auto        value = to_number(found);
      if (!value)
        refuse("Node " + std::to_string(node) + " has the coordinate " +
                 in_quotes(found),
               "A coordinate is a finite number. Usually the mesh program "
               "failed there. Make the mesh anew.");
      return *value;
    }

    long
    integer(const std::string &what)
    {
      const std::string found = word(what);
      const auto        value = to_number(found);
      if (!value || *value != std::floor(*value) || std::abs(*value) > 1e15)
        refuse("Instead of " + what + " there is " + in_quotes(found),
               "Usually a number is missing before, or the file is binary. "
               "Save it as ASCII.");
      return static_cast<long>(*value);
    }

    /** A count of things that take at least @p least letters each. */
    long
    count(const std::string &what, const std::size_t least)
    {
      const long value = integer("the number of " + what);
      if (value < 0 ||
          static_cast<std::size_t>(value) > (text.size() - next) / least + 1)
        refuse("The number of " + what + " is " + std::to_string(value) +
                 ", which the file does not hold",
               "Usually it was edited or cut off. Write the number that is "
               "there, or make the mesh anew.");
      return value;
    }

    void
    skip_line()
    {
      next = std::min(text.find('\n', next), text.size());
      skip_blanks();
    }

    /** Skips to behind this word, which has to come. */
    void
    skip_to(const std::string &end)
    {
      while (word(end) != end)
        {}
    }

    void
    expect(const std::string &wanted)
    {
      const std::string found = word(wanted);
      if (found != wanted)
        refuse("Instead of " + in_quotes(wanted) + " there is " +
                 in_quotes(found),
               "Usually a count before is too small. Make the mesh anew.");
    }

    std::size_t line = 1; // of the word that was read last

  private:
    void
    skip_blanks()
    {
      while (next < text.size() &&
             std::string(" \t\r\n").find(text[next]) != std::string::npos)
        line_of_next += text[next++] == '\n';
    }

    const std::string &text;
    const MeshRequest &request;
    std::size_t        next = 0, line_of_next = 1;
  };



  /** Collects nodes and elements and checks each. */
  template <int dim>
  class MeshBuilder
  {
  public:
    static constexpr unsigned int n_corners = 1 << dim;

    MeshBuilder(MeshWords &words, const bool simplices)
      : words(words)
      , simplices(simplices)
    {}

    void
    add_node(const long number, const std::array<double, 3> &place)
    {
      if (!places.emplace(number, mesh.vertices.size()).second)
        words.refuse("Node " + std::to_string(number) + " is given twice",
                     "Usually two meshes were pasted together. Number the "
                     "nodes anew.");
      if (dim == 2 && place[2] != 0)
        words.refuse("Node " + std::to_string(number) +
                       " has z = " + brief(place[2]),
                     "A plane mesh lies in z = 0. Move it there, or set "
                     "'Dimension = 3' with hexahedra.");
      dealii::Point<dim> point;
      for (int d = 0; d < dim; ++d)
        point[d] = place[d];
      mesh.vertices.push_back(point);
    }

    /**
     * Reads the nodes of the element; mid-face and mid-edge nodes are dropped.
     */
    void
    read_element(const long number, const ElementKind &kind)
    {
      const bool wanted =
        kind.dimension == dim &&
        (kind.n_nodes == n_corners || (simplices && kind.n_nodes == dim + 1));
      if (!wanted && kind.dimension >= dim)
        words.refuse("Element " + std::to_string(number) + " is a " + kind.name,
                     std::string("Only ") +
                       (simplices ?
                          (dim == 2 ? "triangles and " : "tetrahedra and ") :
                          "") +
                       (dim == 2 ? "quadrilaterals of four nodes" :
                                   "hexahedra of eight nodes") +
                       " are taken. In Gmsh, " +
                       (simplices ? "" : "recombine the mesh and ") +
                       "set its order to 1.");
      std::vector<long> nodes(kind.n_nodes);
      for (long &node : nodes)
        node = words.integer("a node of element " + std::to_string(number));
      if (wanted)
        add_element(number, nodes);
    }

    CoarseMesh<dim>
    finish()
    {
      if (mesh.cells.empty())
        words.refuse(std::string("No ") +
                       (simplices ? "element" :
                        dim == 2  ? "quadrilateral" :
                                    "hexahedron") +
                       " was found until the end",
                     "Usually the mesh was saved without its elements, or "
                     "'Dimension' is another. In Gmsh, save all elements.");
      leave_out_unused();
      return mesh;
    }

  private:
    void
    add_element(const long number, const std::vector<long> &nodes)
    {
      const std::string     name = "Element " + std::to_string(number);
      dealii::CellData<dim> cell(nodes.size());
      for (unsigned int i = 0; i < nodes.size(); ++i)
        {
          const auto found = places.find(nodes[i]);
          if (found == places.end())
            words.refuse(name + " has the node " + std::to_string(nodes[i]) +
                           ", which is not given",
                         "Usually nodes were removed. Make the mesh anew.");
          // around the bottom and around the top, as in all three formats
          const unsigned int corner =
            nodes.size() == dim + 1 || i % 4 < 2 ? i : i ^ 1u;
          cell.vertices[corner] = found->second;
        }
      auto sorted = cell.vertices;
      std::sort(sorted.begin(), sorted.end());
      if (std::unique(sorted.begin(), sorted.end()) != sorted.end())
        words.refuse(name + " has one node twice",
                     "Usually an edge has collapsed to a point. Coarsen or "
                     "refine the mesh there.");
      if (!elements.emplace(sorted, number).second)
        words.refuse(name + " has the nodes of element " +
                       std::to_string(elements[sorted]),
                     "Usually two meshes were pasted together. Remove one.");
      orient(name, cell);
      count_faces(name, cell);
      mesh.cells.push_back(cell);
    }

    /** Volume spanned by the edges at a corner (Jacobian determinant), positive
     * in our order of corners. */
    double
    volume_at(const dealii::CellData<dim> &cell, const unsigned int v) const
    {
      dealii::Tensor<2, dim> edges;
      if (cell.vertices.size() == dim + 1)
        {
          for (unsigned int d = 0; d < dim; ++d)
            edges[d] = mesh.vertices[cell.vertices[d + 1]] -
                       mesh.vertices[cell.vertices[0]];
          return determinant(edges);
        }
      for (unsigned int d = 0; d < dim; ++d)
        edges[d] = mesh.vertices[cell.vertices[v | 1u << d]] -
                   mesh.vertices[cell.vertices[v & ~(1u << d)]];
      return determinant(edges);
    }

    /** Some programs number corners the other way around. */
    void
    orient(const std::string &name, dealii::CellData<dim> &cell) const
    {
      double size = 0;
      for (const unsigned int v : cell.vertices)
        size =
          std::max(size,
                   mesh.vertices[v].distance(mesh.vertices[cell.vertices[0]]));
      const double       flat       = 1e-12 * std::pow(size, dim);
      const unsigned int n          = cell.vertices.size();
      unsigned int       n_positive = 0, n_negative = 0;
      for (unsigned int v = 0; v < n; ++v)
        {
          n_positive += volume_at(cell, v) > flat;
          n_negative += volume_at(cell, v) < -flat;
        }
      if (n_positive != n && n_negative != n)
        words.refuse(name + (n_positive > 0 && n_negative > 0 ?
                               " is twisted" :
                               " is flat at a corner"),
                     "Usually its nodes are in a wrong order, or an angle "
                     "has 180 degrees. Improve the mesh there.");
      if (n_negative == n)
        for (unsigned int v = 0; v < (n == dim + 1 ? 2 : n); v += 2)
          std::swap(cell.vertices[v], cell.vertices[v + 1]);
    }

    void
    count_faces(const std::string &name, const dealii::CellData<dim> &cell)
    {
      for (const auto &corners : faces_of_element<dim>(cell.vertices.size()))
        {
          std::vector<unsigned int> face;
          for (const unsigned int v : corners)
            face.push_back(cell.vertices[v]);
          std::sort(face.begin(), face.end());
          if (++n_elements_at[face] > 2)
            words.refuse(name + " is the third one at a face",
                         "Usually two meshes overlap. Keep one of them.");
        }
    }

    void
    leave_out_unused()
    {
      std::vector<int>                number(mesh.vertices.size(), -1);
      std::vector<dealii::Point<dim>> used;
      for (auto &cell : mesh.cells)
        for (unsigned int &v : cell.vertices)
          {
            if (number[v] < 0)
              {
                number[v] = used.size();
                used.push_back(mesh.vertices[v]);
              }
            v = number[v];
          }
      mesh.vertices = used;
    }

    MeshWords                                        &words;
    const bool                                        simplices;
    CoarseMesh<dim>                                   mesh;
    std::unordered_map<long, unsigned int>            places;
    std::map<std::vector<unsigned int>, long>         elements;
    std::map<std::vector<unsigned int>, unsigned int> n_elements_at;
  };
} // namespace limber

#endif
