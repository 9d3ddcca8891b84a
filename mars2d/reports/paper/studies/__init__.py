"""The charts that go beyond one picture of one run, by the law that they study."""
