"""Tables and datasets: ``.csv``, pandas, xarray."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr
from numpy.testing import assert_allclose

import mars2d
from tests.cases import each_case
from tests.output.formats.records import cut_to, everything, refused

NAMES = ["robot0", 'größe, "x"', "robot2", "puck0", "load"]


# -- csv ------------------------------------------------------------------------------------


def test_a_csv_has_a_row_for_each_time_and_body_which_pandas_reads_without_options(tmp_path):
    record = everything()
    frame = pd.read_csv(record.save(tmp_path / "run.csv")).set_index(["time", "body"])
    assert list(frame.columns)[-1] == "record"
    assert len(frame) == 5 * len(record)
    assert frame.index.get_level_values("body")[:6].tolist() == [*NAMES, "robot0"]
    for k, name in enumerate(NAMES[:3]):
        own = frame.xs(name, level="body")
        assert_allclose(own.index, record.time, rtol=1e-15)
        assert_allclose(own[["x", "y", "theta"]], record.pose[:, :, k], rtol=1e-15)
        assert_allclose(own[["command_0", "command_1"]], record.command[:, :, k], rtol=1e-15)
        assert_allclose(own["effort"], record.effort[:, k], rtol=1e-15)
        assert_allclose(own["command_time"], record.command_time, rtol=1e-15)
    load = frame.xs("load", level="body")
    assert_allclose(load[["x", "y", "theta"]], record.prop_pose[:, :, 1], rtol=1e-15)
    assert load[["command_0", "command_time", "effort"]].isna().all(axis=None)
    own = frame.xs("robot2", level="body")
    assert_allclose(own["grid_1_2"], record.sensors["grid"][:, 1, 1, 2], rtol=1e-15)
    assert own["grid_1_1"].tolist() == [np.inf] * len(record)
    assert [*frame.xs("robot0", level="body")["proximity"]] == [*record.sensors["proximity"][:, 0]]


def test_what_does_not_fit_beside_the_rows_of_a_csv_follows_them(tmp_path):
    record = cut_to(everything(), 0)
    path = record.save(tmp_path / "run.csv")
    table = pd.read_csv(path)
    assert len(table) == len(table["record"].dropna()) >= 1
    assert table["time"].isna().all()
    assert mars2d.load(path).digest == record.digest


def test_a_csv_that_was_rounded_or_cut_is_refused(tmp_path):
    path = everything().save(tmp_path / "run.csv")
    table = pd.read_csv(path, dtype={"record": str}, keep_default_na=True)
    table.round(9).to_csv(path, index=False)
    refused(path, "damaged")
    whole = everything().save(path).read_text(encoding="utf-8").splitlines(keepends=True)
    path.write_text("".join(whole[:-1]), encoding="utf-8")
    refused(path, "damaged")
    path.write_text("".join([*whole, whole[-1]]), encoding="utf-8")
    refused(path, "damaged")


@each_case(
    "column, value", [("proximity", "2"), ("command_0", "0.5"), ("body", "puck1"), ("time", "0.2")]
)
def test_a_cell_that_is_not_what_a_record_reads_is_refused_with_its_line(tmp_path, column, value):
    path = everything().save(tmp_path / "run.csv")
    table = pd.read_csv(path, dtype=str, keep_default_na=False)
    puck = table.index[table["body"] == "puck0"][3]
    table.loc[puck, column] = value
    table.to_csv(path, index=False)
    refused(path, f"damaged: line {puck + 2} was changed since it was saved")


# -- xarray and netCDF ----------------------------------------------------------------------


def test_a_dataset_has_named_axes_and_units():
    record = everything()
    dataset = record.to_xarray()
    assert dataset.pose.dims == ("time", "axis", "robot")
    assert dataset.command.dims == ("time", "input", "robot")
    assert dataset.prop_pose.dims == ("time", "axis", "prop")
    assert dataset.effort.dims == ("time", "robot")
    assert dataset.axis.values.tolist() == ["x", "y", "theta"]
    assert dataset.robot.values.tolist() == NAMES[:3]
    assert dataset.prop.values.tolist() == NAMES[3:]
    assert dataset.pose.attrs["units"] == "m, m, rad"
    assert dataset.time.attrs["units"] == "s"
    assert np.array_equal(dataset.pose.sel(robot="robot2", axis="y"), record.pose[:, 1, 2])
    assert all("long_name" in dataset[name].attrs for name in dataset.data_vars)
    assert dataset.attrs["digest"] == record.digest
    assert (dataset.attrs["title"], dataset.attrs["seed"]) == ("Grüße 🤖", str(2**63 - 1))


def test_a_dataset_has_readings_contacts_and_messages():
    record = everything()
    dataset = record.to_xarray()
    assert dataset.sensor_grid.dims == ("time", "grid_robot", "grid_0", "grid_1")
    assert dataset.grid_robot.values.tolist() == ["robot0", "robot2"]
    assert dataset.sensor_proximity.dtype == bool
    assert dataset.contact_point.dims == ("contact", "xy")
    assert dataset.contact_impulse.attrs["units"] == "N s"
    assert np.array_equal(dataset.message_arrival, record.messages["arrival"], equal_nan=True)
    assert dataset.contents.values.tolist() == list(record.contents)
    for name, column in record.columns().items():
        if "content" not in name:
            assert np.array_equal(
                dataset[name.replace(":", "_")], column, equal_nan=column.dtype.kind == "f"
            )


def test_a_dataset_can_be_written_as_netcdf(tmp_path):
    record = mars2d.run("wall_follower", stop_time=0.5)
    record.to_xarray().to_netcdf(tmp_path / "run.nc", engine="scipy")
    with xr.open_dataset(tmp_path / "run.nc", engine="scipy") as read:
        assert np.array_equal(read.pose, record.pose)
        assert "prop_pose" not in read
