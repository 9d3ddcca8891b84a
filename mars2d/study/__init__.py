"""Many runs: sweeps over settings and seeds, and tournaments between laws."""
