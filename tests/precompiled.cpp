// This file is empty: it exists for the precompiled header of its target.
