/// Resources that a renderer holds for the parts of a scene.

import { InstancedMesh, Line, Material, Mesh, Points, ShaderMaterial, Texture, type Object3D } from "three";

/// Frees what renderers hold for a material and its textures.
export function freeMaterial(material: Material): void {
  if (material instanceof ShaderMaterial) {
    for (const { value } of Object.values(material.uniforms)) if (value instanceof Texture) value.dispose();
  }
  material.dispose();
}

/// Frees what renderers hold for the objects of a scene, their materials and textures. They are created again when they
/// are drawn again.
export function freeResources(scene: Object3D): void {
  scene.traverse((object) => {
    if (object instanceof InstancedMesh) object.dispose();
    if (!(object instanceof Mesh || object instanceof Line || object instanceof Points)) return;
    object.geometry.dispose();
    for (const material of [object.material].flat()) freeMaterial(material);
  });
}
