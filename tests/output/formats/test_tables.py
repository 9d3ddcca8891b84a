"""Tables and datasets: ``.csv``, pandas, xarray."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import mars2d
from mars2d import Holonomic, InputError, Robot, Scenario
from mars2d.bodies import Car, Differential
from mars2d.sensors import Pose, RangeFinder
from tests.cases import each_case
from tests.output.formats.records import cut_to, everything, refused

NAMES = ["robot0", 'größe, "x"', "robot2", "puck0", "load"]


# -- pandas ---------------------------------------------------------------------------------


def test_a_frame_has_a_row_for_each_time_and_body():
    record = everything()
    frame = record.to_frame()
    assert frame.index.names == ["time", "body"]
    assert len(frame) == 5 * len(record)
    assert frame.index.get_level_values("body")[:6].tolist() == [*NAMES, "robot0"]
    for k, name in enumerate(NAMES[:3]):
        own = frame.xs(name, level="body")
        assert np.array_equal(own.index, record.time)
        assert np.array_equal(own[["x", "y", "theta"]], record.pose[:, :, k])
        assert np.array_equal(own[["command_0", "command_1"]], record.command[:, :, k])
        assert np.array_equal(own["effort"], record.effort[:, k])
        assert np.array_equal(own["command_time"], record.command_time)
    load = frame.xs("load", level="body")
    assert np.array_equal(load[["x", "y", "theta"]], record.prop_pose[:, :, 1])
    assert load[["command_0", "command_time", "effort"]].isna().all(axis=None)


def test_a_frame_has_a_column_for_each_value_of_a_reading():
    record = everything()
    frame = record.to_frame()
    own = frame.xs("robot2", level="body")
    assert np.array_equal(own["grid_1_2"], record.sensors["grid"][:, 1, 1, 2])
    assert own["grid_1_1"].tolist() == [np.inf] * len(record)
    assert frame.xs("robot0", level="body")["x_0_0"].isna().all()
    assert frame["proximity"].dtype == "boolean"  # which some lack
    assert frame.xs("robot0", level="body")["proximity"].tolist() == [
        bool(near) for near in record.sensors["proximity"][:, 0]
    ]
    assert frame["größe_3"].isna().groupby("body").all().to_dict() == {
        name: name != "robot2" for name in NAMES
    }


@each_case(
    "drives, units",
    [
        ([Holonomic(), Holonomic(max_force=2)], ("m/s", "m/s")),
        ([Car()], ("m/s", "rad")),
        ([Differential()], ("rad/s", "rad/s")),
        ([Differential(command="twist")], ("m/s", "rad/s")),
        ([Car(), Holonomic()], None),
    ],
)
def test_a_frame_knows_the_units_of_its_columns(drives, units):
    sensors = [RangeFinder(beams=2), Pose()]
    robots = [Robot(pose=(k, 0, 0), drive=d, sensors=sensors) for k, d in enumerate(drives)]
    frame = mars2d.run(Scenario(robots=robots, stop_time=0.2)).to_frame()
    found = frame.attrs["units"]
    assert (found["x"], found["theta"], found["command_time"]) == ("m", "rad", "s")
    assert units == ((found["command_0"], found["command_1"]) if "command_0" in found else None)
    assert (found["range_finder_0"], found["range_finder_1"]) == ("m", "m")
    assert [found[f"pose_{k}"] for k in range(3)] == ["m", "m", "rad"]
    assert found.keys() <= set(frame.columns)


def test_a_frame_of_contacts_names_who_touched_whom():
    record = everything()
    frame = record.to_frame("contacts")
    assert len(frame) == len(record.contacts)
    assert frame["body_a"].tolist() == [NAMES[a] for a in record.contacts["a"]]
    assert {"obstacle 0", "load"} <= set(frame["body_b"])
    assert np.array_equal(frame[["normal_x", "normal_y"]], record.contacts["normal"])
    assert frame["began"].dtype == bool
    assert frame.attrs["units"]["impulse"] == "N s"
    assert frame.attrs["units"]["point_y"] == "m"


def test_an_unknown_table_is_refused_with_the_nearest_name():
    with pytest.raises(InputError, match=r"table = 'contact': .*; did you mean 'contacts'\?"):
        everything().to_frame("contact")
    with pytest.raises(InputError, match=r"one of 'bodies', 'contacts', 'messages'$"):
        everything().to_frame(3)


# -- csv ------------------------------------------------------------------------------------


def test_a_csv_is_the_frame_that_pandas_reads_without_options(tmp_path):
    record = everything()
    read = pd.read_csv(record.save(tmp_path / "run.csv")).set_index(["time", "body"])
    assert list(read.columns)[-1] == "record"
    frame = record.to_frame()
    flags = list(frame.select_dtypes("boolean"))
    as_numbers = frame.astype(dict.fromkeys(flags, "Float64")).astype(float)
    pd.testing.assert_frame_equal(read.drop(columns="record"), as_numbers, rtol=1e-15)


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
