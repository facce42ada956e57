"""Every bad input ends with exit code 2 and one message that says where, what, and what would be right."""
import unittest

from command import CommandTest

# Two squares over each other (Gmsh 2.2): nodes 1-4 the lower, 5-8 the upper, groups as in blocks.geo.
NODES = {1: (0, -1), 2: (1, -1), 3: (1, 0), 4: (0, 0), 5: (0, 0), 6: (1, 0), 7: (1, 1), 8: (0, 1)}
GROUPS = {"lower": [(1, 2, 3, 4)], "upper": [(5, 6, 7, 8)], "lower_bottom": [(1, 2)], "lower_top": [(3, 4)],
          "upper_bottom": [(5, 6)], "upper_top": [(7, 8)]}
GMSH_TYPES = {2: 1, 3: 2, 4: 3}  # by number of nodes: line, triangle, quadrangle


def msh(nodes, groups):
    names = {name: (1 if len(entities[0]) == 2 else 2, tag) for tag, (name, entities) in enumerate(groups.items(), 1)}
    elements = [f"{GMSH_TYPES[len(entity)]} 2 {names[name][1]} {names[name][1]} {' '.join(map(str, entity))}"
                for name, entities in groups.items() for entity in entities]
    return "\n".join([
        "$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names)),
        *(f'{dim} {tag} "{name}"' for name, (dim, tag) in names.items()), "$EndPhysicalNames", "$Nodes", str(len(nodes)),
        *(f"{tag} {x} {y} 0" for tag, (x, y) in nodes.items()), "$EndNodes", "$Elements", str(len(elements)),
        *(f"{number} {element}" for number, element in enumerate(elements, 1)), "$EndElements", ""])


class BadDeck(CommandTest):
    def expect(self, message, *replacements):
        self.write_deck(*replacements)
        self.assertRegex(self.expect_error(2, "run", "deck.yaml"), message)

    def test_unknown_key(self):
        self.expect(r"deck.yaml:8:1: .*boundray.*did you mean 'boundary'", ("boundary:", "boundray:"))

    def test_wrong_type(self):
        self.expect(r"deck.yaml:11:\d+: .*loading.increments.*two", ("increments: 2", "increments: two"))

    def test_out_of_range(self):
        self.expect(r"deck.yaml:7:\d+: .*coefficient.*at least 0", ("coefficient: 0.3", "coefficient: -0.3"))
        self.expect(r"deck.yaml:4:\d+: .*poisson.*0\.5", ("lower, material: {law: linear-elastic, young: 1000, poisson: 0.3",
                                                         "lower, material: {law: linear-elastic, young: 1000, poisson: 0.5"))

    def test_not_a_number(self):
        self.expect(r"deck.yaml:4:\d+: .*young", ("lower, material: {law: linear-elastic, young: 1000",
                                                  "lower, material: {law: linear-elastic, young: .nan"))

    def test_not_yaml(self):
        self.expect(r"deck.yaml:3:\d+: not readable as YAML", ("plane-strain}", "plane-strain"))

    def test_missing_group(self):
        self.expect(r"deck.yaml:7:\d+: .*'lower_tops'.*did you mean 'lower_top'", ("lower_top,", "lower_tops,"))

    def test_group_of_the_wrong_dimension(self):
        self.expect(r"deck.yaml:7:\d+: the physical group 'upper' is one of ", ("impactor: upper_bottom", "impactor: upper"))

    def test_impactor_equal_to_its_target(self):
        self.expect(r"deck.yaml:7:\d+: .*impactor and the target are the same, 'lower_top'", ("impactor: upper_bottom", "impactor: lower_top"))

    def test_conflicting_conditions(self):
        self.expect(r"deck.yaml:11:43: displacement y on .upper_top. contradicts displacement y at deck.yaml:10:57", ("loading:", "  - {region: upper_top, displacement: {y: 0.5}}\nloading:"))

    def test_body_that_nothing_holds(self):
        self.expect(r"deck.yaml:4:\d+: body 'below' can move freely",
                    ("  - {region: lower_bottom, fix: [x, y]}\n", "  - {region: lower_bottom, fix: [y]}\n"),
                    ("contact:\n  - {name: interface, impactor: upper_bottom, target: lower_top, "
                     "friction: {law: coulomb, coefficient: 0.3}}\n", ""))

    def test_user_distance_that_does_not_cover_the_target(self):
        self.expect(r"face.*0\.\d+", ("loading:", "detection: {distance: 0.01, method: nearest-node}\nloading:"))

    def test_check_finds_the_same(self):
        self.write_deck(("lower_top,", "lower_tops,"))
        self.assertEqual(self.expect_error(2, "check", "deck.yaml"), self.expect_error(2, "run", "deck.yaml"))

    def test_expression_that_means_nothing(self):
        self.expect(r"deck.yaml:10:\d+: expression .*time", ('"-0.01*t"', '"-0.01*time"'))


class BadMesh(CommandTest):
    def expect(self, message, nodes=None, groups=None):
        text = msh({**NODES, **(nodes or {})}, {**GROUPS, **(groups or {})})
        (self.folder / "mesh.msh").write_text(text, encoding="utf-8")
        self.write_deck(("blocks.geo", "mesh.msh"))
        self.assertRegex(self.expect_error(2, "run", "deck.yaml"), message)
        self.assertEqual(self.record()["status"], "failed")
        self.assertRegex(self.record()["failure"], message)

    def test_the_mesh_itself_is_right(self):
        (self.folder / "mesh.msh").write_text(msh(NODES, GROUPS), encoding="utf-8")
        self.write_deck(("blocks.geo", "mesh.msh"))
        self.succeed("check", "deck.yaml")

    def test_inverted_cell(self):
        self.expect(r"mesh.msh: the quadrilateral 1 \(nodes 1 2 3 4, the first at \(0, -1\)\) is degenerate or not convex", nodes={3: (0.2, -0.9)})

    def test_degenerate_cell(self):
        self.expect(r"mesh.msh: the quadrilateral 2 .* is degenerate", nodes={7: (0.5, 0), 8: (0.25, 0)})

    def test_coordinate_that_is_no_number(self):
        self.expect(r"mesh.msh: node 7 has a coordinate that is not a number", nodes={7: ("nan", 1)})

    def test_welded_bodies(self):
        self.expect(r"deck.yaml:7:\d+: the facet of 'upper_bottom' .* lies between two cells .*meshed with common nodes",
                    groups={"upper": [(4, 3, 7, 8)], "upper_bottom": [(4, 3)]})

    def test_no_mesh(self):
        self.write_deck(("blocks.geo", "mesh.msh"))
        self.assertRegex(self.expect_error(2, "run", "deck.yaml"), r"deck.yaml:2:\d+: mesh.file: there is no file '.*mesh.msh'")

    def test_file_that_is_no_mesh(self):
        (self.folder / "mesh.msh").write_text("solid cube\n", encoding="utf-8")
        self.write_deck(("blocks.geo", "mesh.msh"))
        self.assertRegex(self.expect_error(2, "run", "deck.yaml"), r"deck.yaml:2:\d+: .*mesh.msh")


if __name__ == "__main__":
    unittest.main()
