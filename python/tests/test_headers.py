"""The package against the C headers: every function, option, default and status, and what the docstrings say."""
import inspect
import pathlib
import re

import pytest

import gonio
from gonio import _exceptions
from gonio._backend import ffi, lib

PACKAGE = pathlib.Path(gonio.__file__).parent

# Public functions that the package does without, and why.
UNBOUND = {
    "NumPy does it": """gonio_bin_of gonio_bin_index gonio_bin_from_index gonio_bin_is_valid gonio_cosines
        gonio_pair_from_half_difference gonio_brdf_from_log gonio_log_from_brdf gonio_brdf_from_mapped
        gonio_mapped_from_brdf gonio_basis_singular_value gonio_basis_cumulative_variance gonio_readings_value
        gonio_readings_scale gonio_readings_are_colours gonio_slab_scale gonio_slab_mask gonio_slab_to_log
        gonio_slab_to_mapped gonio_slab_reduce gonio_grid_cells gonio_cell_bin gonio_cell_of_bin
        gonio_delta_e_itp gonio_instrument_deviation""",
    "objects never change": """gonio_readings_set_value gonio_readings_set_values gonio_readings_set_deviations
        gonio_readings_average_repeats gonio_readings_drop_empty_channels gonio_context_resume""",
    "files are written one by one": "gonio_outputs_hold gonio_outputs_release",
    "another function does the same": """gonio_atlas_find gonio_atlas_class gonio_atlas_value gonio_atlas_slab
        gonio_atlas_anisotropic_find gonio_atlas_anisotropic_class gonio_atlas_anisotropic_value
        gonio_atlas_anisotropic_symmetry gonio_anisotropic_material
        gonio_learn gonio_recipe_default gonio_recipe_paper gonio_recipe_default_of gonio_recipe_paper_of
        gonio_recipe_for_grid_of gonio_database_create gonio_measure gonio_table_value gonio_material_read_slab
        gonio_material_write_merl gonio_material_write_rgl gonio_material_writer_find gonio_material_name
        gonio_material_format gonio_image_create gonio_reconstruction_material gonio_reconstruct_tables
        gonio_file_expect gonio_readings_read_text gonio_mesh_triangles gonio_mesh_corners gonio_readings_find
        gonio_reference_create gonio_reference_free gonio_reference_image gonio_reference_tone
        gonio_reference_render gonio_reference_compare gonio_page_is_built gonio_version_number""",
    "experiments with rows of matrices are for C": """gonio_plan_select gonio_plan_rows gonio_condition_number
        gonio_reconstruct_rows gonio_reconstruct_rows_with gonio_reconstruct_material gonio_material_rows
        gonio_bivariate_material gonio_basis_position gonio_basis_row_at gonio_basis_convert gonio_database_describe
        gonio_database_read_rows gonio_plan_write_history""",
    "plans and rehearsals call them": """gonio_instrument_candidates gonio_instrument_value_factor
        gonio_instrument_aperture_samples gonio_instrument_aperture""",
    "anisotropic reconstructions are for C and the command line so far": """gonio_reconstruct_anisotropic
        gonio_anisotropic_reconstruction_free gonio_anisotropic_reconstruction_describe
        gonio_anisotropic_reconstruction_predict gonio_anisotropic_reconstruction_predict_readings
        gonio_anisotropic_reconstruction_material
        gonio_check_isotropy""",
    "of the C interface alone": """gonio_material_create gonio_fingerprint_create gonio_fingerprint_add
        gonio_fingerprint_value gonio_fingerprint_free gonio_kind_format gonio_material_writer_extension
        gonio_material_writer_summary gonio_material_writer_averages gonio_instrument_pair_obstacle gonio_instrument_region_obstacle
        gonio_plan_method_summary gonio_plan_method_reconstruction
        gonio_plan_method_basis gonio_plan_start_name gonio_plan_start_summary gonio_reconstruct_method_summary
        gonio_reconstruct_method_suits_mixtures gonio_readings_format_word gonio_reference_read gonio_reflectance_directions
        gonio_material_reflectance gonio_environment_summary gonio_instrument_summary gonio_kinematics_name
        gonio_kinematics_summary gonio_value_kind_name
        gonio_comparison_picture_write_png gonio_tone_apply gonio_srgb_encode""",
}
KINDS = ("basis context database environment image instrument material mesh plan readings reconstruction survey table").split()

# Fields of options and the parameters that they are; None: the package sets them itself.
OPTIONS = {
    "plan": (gonio.Basis.plan, dict(method="method", start="start", components="components", count="n",
                                    restarts="restarts", seed="seed", keep_history=None, phi_d="phi_d", metric="metric",
                                    candidates="candidates", candidate_count="candidates", target="target_error",
                                    budget="budget", nested="nested", anisotropic=None,
                                    instrument="instrument")),
    "reconstruct": (gonio.reconstruct, dict(components="components", all_channels="all_channels",
                                            other_basis="other_basis", method="method", eta="eta", noise="noise",
                                            floor="floor", saturation="saturation", deviation=None,
                                            expected_at=None, expected_count=None,
                                            no_checks="checks", symmetry=None,
                                            source_aperture="source_aperture",
                                            detector_aperture="detector_aperture")),
    "render": (gonio.render, dict(width="width", height="height", samples="samples", seed="seed", mesh="mesh",
                                  environment="environment", environment_turn="environment_turn",
                                  show_environment="show_environment", lamp="lamp", lamp_position="lamp_position",
                                  azimuth="azimuth", elevation="elevation", field_of_view="field_of_view",
                                  grain="grain", flat="flat")),
    "instrument": (gonio.Readings.measured, dict(noise="noise", floor="floor", seed="seed", outliers="outliers")),
    "write": (gonio.Material.save, dict(format="format", theta_i_step="theta_i_step", theta_o_step="theta_o_step",
                                        phi_step="phi_step", average_azimuths="average_azimuths")),
    "readings": (gonio.Readings.load, {"values_needed": "values_needed", "average_repeats": "average_repeats",
                                       "negative_to_zero": "negative_to_zero", "as": "convention",
                                       "instrument": "instrument", "directions_only": None}),
    "basis": (gonio.learn, dict(components="components", subset=None, subset_count=None, without_mean="mean",
                                mixtures="mixtures", seed="seed", analytic="analytic")),
    "database": (gonio.learn, dict(representation="grid", channels="channels", scratch="scratch", mapping="mapping")),
    "context": (gonio.settings.__init__, dict(message=None, progress=None, user=None, threads=None)),
}
NEGATED = {"no_checks", "without_mean"}


def declared(source):
    text = "".join(path.read_text() for path in sorted((source / "include/gonio").glob("*.h")))
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    return set(re.findall(r"\b(gonio_\w+)\s*\(", " ".join(re.findall(r"GONIO_API[^;]*;", text, flags=re.S))))


def test_every_function_is_used_or_named(source):
    written = "".join(path.read_text() for path in PACKAGE.glob("*.py"))
    written += "".join(path.read_text() for path in (source / "python/kernels").glob("*.c"))
    used = set(re.findall(r"\bgonio_\w+", written)) | {f"gonio_{kind}_free" for kind in KINDS}
    used |= {f"{name}_options_default_of" for name in (f"gonio_{kind}" for kind in OPTIONS)}
    used |= {f"gonio_{kind}_parse" for kind in ("representation", "mapping", "channel_model")}
    unbound = set(" ".join(UNBOUND.values()).split())
    functions = declared(source)
    assert len(functions) > 150
    assert sorted(functions - used - unbound) == []
    assert sorted(f for f in unbound - functions if not hasattr(lib, f)) == []
    for name in functions:
        assert hasattr(lib, name), name


@pytest.mark.parametrize("kind", OPTIONS)
def test_every_option_is_a_parameter(kind):
    function, fields = OPTIONS[kind]
    struct = ffi.new(f"gonio_{kind}_options *")
    getattr(lib, f"gonio_{kind}_options_default")(struct)
    names = [name for name, _ in ffi.typeof(struct).item.fields]
    assert names[0] == "size" and sorted(names[1:]) == sorted(fields)
    parameters = inspect.signature(function).parameters
    compared = 0
    for field, name in fields.items():
        if name is None:
            continue
        default = parameters[name].default
        assert name in (function.__doc__ or ""), f"{name} is not in the docstring"
        if isinstance(default, (bool, int, float)):
            usual = getattr(struct, field)
            assert default == pytest.approx((not usual) if field in NEGATED else usual), name
            compared += 1
    assert compared > 1 or kind in ("database", "context")


def test_defaults_that_are_words():
    plan, database, render = (ffi.new(f"gonio_{kind}_options *") for kind in ("plan", "database", "render"))
    lib.gonio_plan_options_default(plan)
    lib.gonio_database_options_default(database)
    lib.gonio_render_options_default(render)
    default = {**inspect.signature(gonio.Basis.plan).parameters, **inspect.signature(gonio.learn).parameters,
               **inspect.signature(gonio.render).parameters}
    assert lib.gonio_metric_find(default["metric"].default.encode()) == plan.metric
    assert ffi.string(lib.gonio_representation_name(database.representation)).decode() == default["grid"].default
    assert ffi.string(lib.gonio_mapping_name(database.mapping)).decode() == default["mapping"].default
    assert gonio._rendering.LAMPS[default["lamp"].default] == render.lamp
    assert {n: p.default for n, p in inspect.signature(gonio.Regressor).parameters.items() if n in (
        "noise", "floor", "saturation", "checks")} == {
        n: p.default for n, p in inspect.signature(gonio.reconstruct).parameters.items() if n in (
            "noise", "floor", "saturation", "checks")}


def test_every_status_is_an_exception(source):
    text = (source / "include/gonio/status.h").read_text()
    errors = dict(re.findall(r"(GONIO_ERROR_\w+) = (\d+)", text))
    assert {int(number) for number in errors.values()} == set(_exceptions.BY_STATUS)
    assert len(set(_exceptions.BY_STATUS.values())) == len(errors)
    for kind in _exceptions.BY_STATUS.values():
        assert issubclass(kind, gonio.GonioError) and getattr(gonio, kind.__name__) is kind


def test_version_and_sizes():
    assert gonio.__version__ == f"{lib.GONIO_VERSION_MAJOR}.{lib.GONIO_VERSION_MINOR}.{lib.GONIO_VERSION_PATCH}"
    assert ffi.sizeof("gonio_pair") == 4 * 8


def public():
    for name in gonio.__all__:
        thing = getattr(gonio, name)
        yield name, thing
        if inspect.isclass(thing):
            for inner, value in vars(thing).items():
                if not inner.startswith("_"):
                    yield f"{name}.{inner}", getattr(thing, inner)


@pytest.mark.parametrize("name, thing", [(n, t) for n, t in public() if n != "settings"])
def test_docstrings(name, thing):
    text = inspect.getdoc(thing) or ""
    if name == "Readings.channels" or isinstance(thing, (str, int, type(None))):
        return
    assert text, f"{name} has no docstring"
    if not callable(thing) or (inspect.isclass(thing) and issubclass(thing, (Exception,))):
        return
    if "Parameters\n" in text:
        for parameter in inspect.signature(thing).parameters:
            assert parameter in ("self",) or re.search(rf"\b{parameter}\b", text), f"{name}: {parameter}"


def test_help_is_enough_to_start():
    text = inspect.getdoc(gonio)
    for name in ("Basis.load", "Regressor", "plan", "return_std", "radians", "1/sr", "unit vectors", "GonioError"):
        assert name in text
