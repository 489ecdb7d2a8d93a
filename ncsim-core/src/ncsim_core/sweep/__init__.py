"""Many runs from one file: what to vary, where to run it, where results stay, what they mean."""
