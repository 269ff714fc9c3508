"""The rooms of the project that faults are planted in, by patterns of paths (the first that fits a file is its room), and
the tests that touch each: programs of tests/ by the name that Meson knows, files of tests/ in Python.

A test that no line names touches every room of src. What a row leaves out can only make the score lower."""

import fnmatch

ROOMS = {
    "kernels": (["kernels/*"],
                """kernels mixed_mode interface tile_faces reference laws friction viscosity elastic j2 johnson_cook
                   johnson_holmquist drucker_prager holmquist_johnson_cook thermal prestress rise contact_twin crack_front
                   ledger step_limiter spectrum tie probe sides coarse viscoelastic bulk_history anisotropic contact
                   deshpande_evans deshpande_evans_kernel cost_model material step heat initial snapshot strength opening
                   crack_tip sensor balance checkpoint fragment_twin test_thermal.py test_user_materials.py
                   test_invariance.py test_contact.py test_friction.py test_viscosity.py test_laws.py test_ceramic.py
                   test_solids.py test_ledger.py test_crystals.py test_fragment_contact.py test_spall.py"""),
    "mesh/import": (["src/mesh/import/*"],
                    """crack apart near frame gmsh_errors inp inp_nodes inp_sets inp_split import unpack vtk sets mesh
                       mesh_file mesh_command fuzz-inp fuzz-vtk test_inputs.py test_parts.py test_abaqus.py test_gmsh.py
                       test_mesh_faults.py test_meshes.py"""),
    "mesh/improve": (["src/mesh/improve/*"], "improve test_meshes.py"),
    "mesh": (["src/mesh/*"],
             """apart near sets mesh mesh_check mesh_command mesh_damage mesh_info mesh_file tiles part part_read domain
                fuzz-mesh crack import improve mesh_case fuzz-inp fuzz-vtk inp assembly fragment body load material_map
                test_parts.py test_mesh_faults.py test_meshes.py test_invariance.py test_partition.py test_cli.py"""),
    "partition": (["src/partition/*"],
                  """contact_twin summary body sides heat strength checkpoint mesh_case tiles part part_read patch material
                     materials material_map anisotropic spectrum step verify assembly checkpoint_file domain fuzz-mesh
                     crack_front crack_tip fragment initial load ledger rebalance estimate snapshot mesh coarse opening
                     test_parts.py test_user_materials.py test_mesh_faults.py test_bimaterials.py test_partition.py
                     test_meshes.py test_cli.py test_continuous.py test_crystals.py test_parallel.py"""),
    "contact": (["src/contact/*"],
                """grip search contact_twin contact balance crack_front checkpoint test_parts.py test_fragment_contact.py
                   test_parallel.py test_restart.py"""),
    "domain": (["src/domain/*"],
               """domain assembly slab patch step spectrum fragment verify fragment_twin ledger snapshot contact_twin
                  crack_front probe sensor opening tie sides load checkpoint checkpoint_file fuzz-checkpoint estimate
                  rebalance crack_tip strength body coarse heat initial numbers step_limiter test_invariance.py
                  test_contact.py test_bodies.py test_continuous.py test_fragments.py test_solids.py test_bimaterials.py
                  test_open_faces.py test_ledger.py test_spall.py test_parallel.py"""),
    "solver": (["src/solver/*"],
               """heat opening contact_twin crack_front rebalance probe sensor crack_tip step spectrum balance body attitude
                  law load sides coarse initial tie rest mixed_mode checkpoint step_limiter strength patch material verify case
                  checkpoint_file ledger snapshot estimate fragment fragment_twin fuzz-checkpoint assembly test_thermal.py
                  test_equilibrium.py test_invariance.py test_contact.py test_friction.py test_viscosity.py test_bodies.py
                  test_output.py test_continuous.py test_ceramic.py test_laws.py test_ledger.py test_spall.py test_solids.py
                  test_waves.py test_bimaterials.py test_fragments.py test_impact.py test_partition.py test_moments.py
                  test_open_faces.py test_kept_keys.py test_loads.py test_sides.py test_supports.py test_static.py
                  test_static_bodies.py test_crystals.py
                  test_fragment_contact.py test_parallel.py test_restart.py"""),
    "diagnostics": (["src/diagnostics/*"],
                    """crack_front files run snapshot summary step exact_sum fragment fragment_table fragment_twin ledger
                       probe sensor crack_tip verify rebalance checkpoint checkpoint_file test_crack_fronts.py
                       test_thermal.py test_output.py test_invariance.py test_friction.py test_viscosity.py test_bodies.py
                       test_ceramic.py test_fragments.py test_sensors.py test_moments.py test_sides.py test_ledger.py
                       test_spall.py test_faults.py test_bimaterials.py test_cli.py test_impact.py test_parallel.py
                       test_restart.py"""),
    "output": (["src/output/*"],
               """writer slab estimate fragment_table progress snapshot summary xdmf run rebalance test_output.py
                  test_export.py test_moments.py test_supports.py test_loads.py test_open_faces.py test_thermal.py test_bodies.py
                  test_invariance.py test_spall.py test_cli.py test_bimaterials.py test_fragments.py test_fragment_contact.py
                  test_faults.py test_parallel.py test_restart.py"""),
    "restart": (["src/restart/*"],
                """checksum slab schedule restart checkpoint checkpoint_file fuzz-checkpoint rebalance test_output.py
                   test_faults.py test_cli.py test_restart.py test_partition.py"""),
    "verify": (["src/verify/*"], "verify test_verify.py"),
    "case": (["src/case/*"],
             """case user user_check user_law_check files body attitude law run assembly case_anisotropic tables presets load
                case_text case_echo case_ranges case_rules case_boundary case_values case_mistakes keys expressions numbers
                strength fuzz-case mesh_case initial heat material materials material_map checkpoint
                checkpoint_file estimate snapshot crack_front sides contact_twin rebalance step tie coarse opening
                test_user_materials.py test_thermal.py test_equilibrium.py test_keys.py test_output.py test_laws.py
                test_bodies.py test_cli.py test_sensors.py test_supports.py test_static.py test_loads.py test_bimaterials.py
                test_continuous.py test_restart.py"""),
    "base": (["src/*"],
             """numbers material_command apart mem stiffness exact_sum exchange error files interrupt run mesh_command
                h5_parallel rebalance slab checksum writer fragment verify checkpoint_file fragment_table fragment_twin
                ledger probe summary checkpoint step tie sides heat assembly materials material material_map attitude
                contact_twin load snapshot opening spectrum coarse crack_front estimate initial mesh_damage mesh_case crack
                fuzz-checkpoint fuzz-inp fuzz-vtk fuzz-mesh case_anisotropic case_rules part_read import sets test_parts.py test_keys.py
                test_user_materials.py test_output.py test_mesh_faults.py test_faults.py test_cli.py test_fragments.py
                test_meshes.py test_partition.py test_restart.py"""),
    "plot": (["bench/plot", "bench/drawing.py", "bench/theory.py", "bench/rhegma.py",
              "bench/page.py"],
             """test_plot.py test_page.py test_bench_modules.py test_plot_impact.py test_studies.py test_scripts.py"""),
}
ELSEWHERE = ("test_count.py", "test_curves.py", "test_documents.py", "test_figures.py", "test_install.py",
             "test_material_curves.py", "test_mutate.py", "test_perf.py", "test_rooms.py", "test_scaling.py", "test_validate.py")  # tests of no room here
LEAST = 10  # faults of a room in a campaign: one that survives leaves 90 %
PASSED_BY = ("src/main.c", "src/gmsh_main.c", "src/usage.c")  # the words of the command line, and nothing else


def room_of(path):
    if path in PASSED_BY or path.startswith(("src/", "kernels/")) and not path.endswith((".c", ".h")):
        return None
    return next((room for room, (patterns, _) in ROOMS.items() if any(fnmatch.fnmatch(path, p) for p in patterns)), None)


def touches(test, path):
    """Whether a test touches a file. test: its name in Meson without the number of ranks, or its file."""
    listed = ROOMS[room_of(path)][1].split()
    if test in listed:
        return True
    return path.startswith("src/") and test not in ELSEWHERE and not any(test in tests.split() for _, tests in ROOMS.values())


def shares(lines, count):
    """How many of `count` faults each room gets: as it has lines, but no room less than `LEAST`."""
    total = sum(lines.values())
    least = min(LEAST, count // len(lines))
    exact = {room: least + (count - least * len(lines)) * n / total for room, n in lines.items()}
    share = {room: int(x) for room, x in exact.items()}
    for room in sorted(exact, key=lambda r: share[r] - exact[r])[: count - sum(share.values())]:
        share[room] += 1
    return share
