#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

/// Binary .msh files, written apart from the reader: what msh_text_2 and msh_text_4 say.
namespace halfshade::test {

/// Numbers as Gmsh writes them, in this machine's byte order or the other one.
class MshBytes {
 public:
  explicit MshBytes(bool swapped) : swapped_(swapped) {}

  MshBytes& text(const std::string& line) {
    bytes_ += line;
    return *this;
  }
  template <class... Values>
  MshBytes& ints(Values... values) {
    (add(static_cast<std::int32_t>(values)), ...);
    return *this;
  }
  template <class... Values>
  MshBytes& sizes(Values... values) {
    (add(static_cast<std::uint64_t>(values)), ...);
    return *this;
  }
  template <class... Values>
  MshBytes& reals(Values... values) {
    (add(static_cast<double>(values)), ...);
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  template <class Value>
  void add(Value value) {
    char raw[sizeof(Value)];
    std::memcpy(raw, &value, sizeof(Value));
    if (swapped_) std::reverse(raw, raw + sizeof(Value));
    bytes_.append(raw, sizeof(Value));
  }

  bool swapped_;
  std::string bytes_;
};

inline const char* const msh_names =
    "$PhysicalNames\n3\n1 1 \"rim\"\n2 1 \"the floor\"\n2 7 \"lid\"\n$EndPhysicalNames\n";

inline std::string msh_text_2() {
  return std::string("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n") + msh_names +
         "$Nodes\n4\n1 0.1 0 0\n2 1 0 0\n30 1 1 0\n4 0 1 0\n$EndNodes\n"
         "$Elements\n6\n1 15 2 0 1 1\n2 1 2 1 1 1 2\n3 3 2 1 1 1 2 30 4\n4 2 2 7 1 1 2 30\n"
         "5 2 2 9 1 1 30 4\n6 4 2 0 1 1 2 30 4\n$EndElements\n";
}

inline std::string msh_binary_2(bool swapped) {
  MshBytes out(swapped);
  out.text("$MeshFormat\n2.2 1 8\n").ints(1).text("\n$EndMeshFormat\n").text(msh_names);
  out.text("$Nodes\n4\n").ints(1).reals(0.1, 0, 0).ints(2).reals(1, 0, 0).ints(30);
  out.reals(1, 1, 0).ints(4).reals(0, 1, 0).text("\n$EndNodes\n");
  out.text("$Elements\n6\n").ints(15, 1, 2, 1, 0, 1, 1).ints(1, 1, 2, 2, 1, 1, 1, 2);
  out.ints(3, 1, 2, 3, 1, 1, 1, 2, 30, 4);
  out.ints(2, 2, 2, 4, 7, 1, 1, 2, 30, 5, 9, 1, 1, 30, 4);
  out.ints(4, 1, 2, 6, 0, 1, 1, 2, 30, 4).text("\n$EndElements\n");
  return out.text("$NodeData\nwhatever\n").ints(1, 2, 3).text("\n$EndNodeData\n").bytes();
}

inline std::string msh_text_4() {
  return std::string("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n") + msh_names +
         "$Entities\n1 1 3 0\n4 0 0 0 0\n9 0 0 0 1 1 0 1 1 2 4 -4\n5 0 0 0 1 1 0 1 1 1 9\n"
         "6 0 0 0 1 1 0 2 7 1 0\n8 0 0 0 1 1 0 0 0\n$EndEntities\n"
         "$Nodes\n2 4 1 30\n2 5 1 3\n1\n2\n30\n0.1 0 0 5 6\n1 0 0 5 6\n1 1 0 5 6\n0 1 0 1\n4\n"
         "0 1 0\n$EndNodes\n"
         "$Elements\n4 5 1 5\n1 9 1 1\n1 1 2\n2 5 3 1\n2 1 2 30 4\n2 6 2 2\n3 1 2 30\n4 1 30 4\n"
         "3 1 4 1\n5 1 2 30 4\n$EndElements\n";
}

inline std::string msh_binary_4(bool swapped) {
  MshBytes out(swapped);
  out.text("$MeshFormat\n4.1 1 8\n").ints(1).text("\n$EndMeshFormat\n").text(msh_names);
  out.text("$Entities\n").sizes(1, 1, 3, 0);
  out.ints(4).reals(0, 0, 0).sizes(0);
  out.ints(9).reals(0, 0, 0, 1, 1, 0).sizes(1).ints(1).sizes(2).ints(4, -4);
  out.ints(5).reals(0, 0, 0, 1, 1, 0).sizes(1).ints(1).sizes(1).ints(9);
  out.ints(6).reals(0, 0, 0, 1, 1, 0).sizes(2).ints(7, 1).sizes(0);
  out.ints(8).reals(0, 0, 0, 1, 1, 0).sizes(0, 0).text("\n$EndEntities\n");
  out.text("$Nodes\n").sizes(2, 4, 1, 30).ints(2, 5, 1).sizes(3, 1, 2, 30);
  out.reals(0.1, 0, 0, 5, 6).reals(1, 0, 0, 5, 6).reals(1, 1, 0, 5, 6);
  out.ints(0, 1, 0).sizes(1, 4).reals(0, 1, 0).text("\n$EndNodes\n");
  out.text("$Elements\n").sizes(4, 5, 1, 5).ints(1, 9, 1).sizes(1, 1, 1, 2);
  out.ints(2, 5, 3).sizes(1, 2, 1, 2, 30, 4).ints(2, 6, 2).sizes(2, 3, 1, 2, 30, 4, 1, 30, 4);
  return out.ints(3, 1, 4).sizes(1, 5, 1, 2, 30, 4).text("\n$EndElements\n").bytes();
}

}  // namespace halfshade::test
