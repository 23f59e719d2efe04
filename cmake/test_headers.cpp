// The unit of the precompiled headers of tests, which has nothing of its own.
