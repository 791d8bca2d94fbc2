"""Names of joints and markers, and the places on the body that they mean.

The conventions stand here and not with the body model, since both drafting, which may not know
the model, and fitting, which stands above the readers, need them.
"""
